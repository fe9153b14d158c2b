// SPDX-License-Identifier: BSD-3-Clause
// Allows one lockstep simulator per UDP port of this machine: else processes would answer the ticks
// of another run.
#pragma once

#include "common/bus/channel_names.hpp"

#include <string>

namespace waymark {

/// Held during the object's lifetime; the system releases it however the process ends. No lock is
/// needed, nor taken, on networks other than udpm, and for other names of the channel TICK.
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
