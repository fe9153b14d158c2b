// SPDX-License-Identifier: BSD-3-Clause
// Exceptions of a tool -> lines on standard error and exit codes. Programs that log use guard.hpp.
#pragma once

#include "common/errors/exit_codes.hpp"

#include <functional>
#include <string_view>

namespace waymark {

/// Does a tool's work. What it throws, and standard output that cannot be written, are reported on
/// standard error.
/// @param code_of_errors  the exit code after an exception that is no SetupError
/// @return the exit code: that of `work`; kExitUsage after a SetupError; kExitFailed if the output
///         is lost.
int run_tool(std::string_view program, const std::function<int()>& work,
             int code_of_errors = kExitFailed);

}  // namespace waymark
