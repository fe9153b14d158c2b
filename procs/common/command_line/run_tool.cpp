// SPDX-License-Identifier: BSD-3-Clause
#include "common/command_line/run_tool.hpp"

#include "common/errors/setup_error.hpp"

#include <fmt/format.h>

#include <cerrno>
#include <cstdio>
#include <system_error>

namespace waymark {

int run_tool(std::string_view program, const std::function<int()>& work, int code_of_errors) {
  const auto fail = [&](std::string_view what, int code) {
    fmt::print(stderr, "{}: {}\n", program, what);
    return code;
  };
  try {
    const int code = work();
    if (std::fflush(stdout) == 0) return code;
    const std::string why = std::generic_category().message(errno);
    return fail("standard output cannot be written: " + why, code == kExitOk ? kExitFailed : code);
  } catch (const SetupError& error) {
    return fail(error.what(), kExitUsage);
  } catch (const std::exception& error) {
    return fail(error.what(), code_of_errors);
  }
}

}  // namespace waymark
