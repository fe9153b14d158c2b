// SPDX-License-Identifier: BSD-3-Clause
// Exceptions -> messages and exit codes. Programs that log use run_guarded() (guard.hpp).
#pragma once

#include "common/errors/exit_codes.hpp"

#include <functional>
#include <string_view>

namespace waymark {

/// Does a program's work, and reports what it throws, and standard output that cannot be written.
/// @param code_of_errors  the exit code after an exception that is no SetupError
/// @return the exit code: that of `work`; kExitUsage after a SetupError; kExitFailed if the output
///         is lost.
int run_and_report(const std::function<int()>& work,
                   const std::function<void(std::string_view)>& report,
                   int code_of_errors = kExitFailed);

/// The same for a tool, which reports on standard error.
int run_tool(std::string_view program, const std::function<int()>& work,
             int code_of_errors = kExitFailed);

}  // namespace waymark
