// SPDX-License-Identifier: BSD-3-Clause
// One simulator in lockstep per UDP port of this machine: processes would answer the ticks of
// another's run.
#pragma once

#include "common/bus/channel_names.hpp"

#include <string>

namespace waymark {

/// Held while it lives, and let go by the system however the process ends. On other networks than
/// udpm it keeps nobody out; nor does it with another name of TICK, under which runs do not meet.
class SimulatorLock {
 public:
  /// @throws SetupError when another simulator has the port, or the system refuses the lock.
  SimulatorLock(const std::string& lcm_url, const ChannelNames& names);
  ~SimulatorLock();
  SimulatorLock(const SimulatorLock&) = delete;
  SimulatorLock& operator=(const SimulatorLock&) = delete;

 private:
  int socket_{-1};
};

}  // namespace waymark
