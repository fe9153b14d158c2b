// SPDX-License-Identifier: BSD-3-Clause
#include "support/programs.hpp"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <fstream>
#include <sstream>
#include <thread>

namespace waymark::testing_support {
namespace {

using std::chrono::steady_clock;

template <class Condition>
bool wait_until(Condition condition, std::chrono::seconds timeout) {
  const auto end = steady_clock::now() + timeout;
  while (!condition()) {
    if (steady_clock::now() > end) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds{20});
  }
  return true;
}

std::string command_line_of(const std::filesystem::path& process_folder) {
  std::ifstream file{process_folder / "cmdline", std::ios::binary};
  std::stringstream text;
  text << file.rdbuf();
  return text.str();
}

std::optional<pid_t> find_process(const std::vector<std::string>& words) {
  for (const auto& entry : std::filesystem::directory_iterator{"/proc"}) {
    const std::string name = entry.path().filename();
    if (!std::ranges::all_of(name, [](unsigned char c) { return std::isdigit(c) != 0; })) continue;
    const pid_t pid = std::stoi(name);
    const std::string line = command_line_of(entry.path());
    const bool has_all = std::ranges::all_of(
        words, [&line](const std::string& word) { return line.find(word) != std::string::npos; });
    if (has_all && !line.starts_with("sh") && pid != getpid()) return pid;
  }
  return std::nullopt;
}

}  // namespace

Finished run_command(const std::string& command) {
  Finished finished;
  FILE* pipe = popen((command + " 2>&1 </dev/null").c_str(), "r");
  if (pipe == nullptr) throw std::runtime_error{"cannot run " + command};
  std::array<char, 4096> buffer{};
  while (const std::size_t count = fread(buffer.data(), 1, buffer.size(), pipe)) {
    finished.output.append(buffer.data(), count);
  }
  const int status = pclose(pipe);
  finished.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  return finished;
}

std::optional<pid_t> wait_for_process(const std::vector<std::string>& words,
                                      std::chrono::seconds timeout) {
  std::optional<pid_t> pid;
  wait_until([&] { return (pid = find_process(words)).has_value(); }, timeout);
  return pid;
}

std::string content_of(const std::filesystem::path& file) {
  std::ifstream stream{file, std::ios::binary};
  EXPECT_TRUE(stream) << file << " is missing";
  std::stringstream text;
  text << stream.rdbuf();
  return text.str();
}

bool wait_for_size(const std::filesystem::path& file, std::uintmax_t bytes,
                   std::chrono::seconds timeout) {
  return wait_until(
      [&] {
        std::error_code error;
        const auto size = std::filesystem::file_size(file, error);
        return !error && size >= bytes;
      },
      timeout);
}

}  // namespace waymark::testing_support
