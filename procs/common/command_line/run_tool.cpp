// SPDX-License-Identifier: BSD-3-Clause
#include "common/command_line/run_tool.hpp"

#include "common/errors/setup_error.hpp"

#include <fmt/format.h>

#include <cerrno>
#include <cstdio>
#include <system_error>

namespace waymark {

int run_and_report(const std::function<int()>& work,
                   const std::function<void(std::string_view)>& report, int code_of_errors) {
  try {
    const int code = work();
    // Only when the rest of the buffer is written, a full disk may show.
    if (std::fflush(stdout) == 0) return code;
    report("standard output cannot be written: " + std::generic_category().message(errno));
    return code == kExitOk ? kExitFailed : code;
  } catch (const SetupError& error) {
    report(error.what());
    return kExitUsage;
  } catch (const std::exception& error) {
    report(error.what());
    return code_of_errors;
  }
}

int run_tool(std::string_view program, const std::function<int()>& work, int code_of_errors) {
  const auto report = [&](std::string_view what) {
    fmt::print(stderr, "{}: {}\n", program, what);
  };
  return run_and_report(work, report, code_of_errors);
}

}  // namespace waymark
