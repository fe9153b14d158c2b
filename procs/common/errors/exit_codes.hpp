// SPDX-License-Identifier: BSD-3-Clause
// What a program's exit status says; the same for programs and scripts.
#pragma once

namespace waymark {

enum ExitCode : int {
  kExitOk = 0,
  kExitFailed = 1,
  kExitUsage = 2,  ///< bad usage or set-up
  kExitDied = 3,   ///< a process died (deploy/launch.sh)
  kExitTimeout = 4,
  kExitSignal = 128,  ///< + number of the signal
};

}  // namespace waymark
