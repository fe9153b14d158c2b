// SPDX-License-Identifier: BSD-3-Clause
// SIGINT, SIGTERM and SIGHUP as a flag.
#pragma once

namespace waymark {

/// Makes the first of these signals set the flag, and another one more than 0.3 s later end the
/// process at once. SIGPIPE is ignored.
void install_stop_signals();

/// The signal that asked to stop, or 0.
int stop_signal();

}  // namespace waymark
