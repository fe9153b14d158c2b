// SPDX-License-Identifier: BSD-3-Clause
// Exceptions -> one clear line and an exit code.
#pragma once

#include "common/node/node.hpp"

#include <functional>

namespace waymark {

/// Runs `body` with signals and logging set up; says what went wrong on standard error.
int run_guarded(const ProcessTraits& traits, const std::function<int()>& body);

/// Lets a node work on messages; what it throws is named.
/// @return whether it threw nothing.
bool works(const std::function<void()>& on_messages);

/// Prints all counters that are not zero, one line per kind; losses and rejections as warnings.
void log_counters(const Counters& counters);

}  // namespace waymark
