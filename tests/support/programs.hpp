// SPDX-License-Identifier: BSD-3-Clause
// Running our real programs and scripts from a test.
#pragma once

#include <sys/types.h>

#include <chrono>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace waymark::testing_support {

struct Finished {
  int exit_code{0};
  std::string output{};  ///< standard output and standard error
};

/// Runs a shell command to its end.
Finished run_command(const std::string& command);

/// Waits for a process whose command line contains all the words; nullopt after `timeout`.
std::optional<pid_t> wait_for_process(const std::vector<std::string>& words,
                                      std::chrono::seconds timeout);

/// Whole content of a file; fails the test when there is none.
std::string content_of(const std::filesystem::path& file);

/// Waits until the file has at least so many bytes.
bool wait_for_size(const std::filesystem::path& file, std::uintmax_t bytes,
                   std::chrono::seconds timeout);

}  // namespace waymark::testing_support
