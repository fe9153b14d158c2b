// SPDX-License-Identifier: BSD-3-Clause
// Exceptions -> log lines and exit codes.
#pragma once

#include "common/node/node.hpp"

#include <functional>

namespace waymark {

/// Sets up signals and logging, runs `body`, and logs what it throws.
/// @return the exit code: that of `body`; kExitUsage or kExitFailed after an exception; kExitFailed
///         if what it printed to standard output could not be written.
int run_guarded(const ProcessTraits& traits, const std::function<int()>& body);

/// Runs `work`, in which a node handles messages, and logs what it throws.
/// @return false after an exception.
bool run_and_log_errors(const std::function<void()>& work);

/// Logs all counters that are not zero, one line per kind; losses and rejections as warnings.
void log_counters(const Counters& counters);

}  // namespace waymark
