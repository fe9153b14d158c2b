// SPDX-License-Identifier: BSD-3-Clause
// Allows one lockstep simulator per UDP port of this machine: with two, processes would answer the
// ticks of the other's run.
#pragma once

#include "common/bus/channel_names.hpp"

#include <string>

namespace waymark {

/// Held during the object's lifetime; the system releases it however the process ends. It covers
/// one port and one name of the channel TICK; on networks other than udpm nothing is locked.
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
