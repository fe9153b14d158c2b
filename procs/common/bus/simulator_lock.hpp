// SPDX-License-Identifier: BSD-3-Clause
// Allows one lockstep simulator per UDP port of this machine: with two, a process could
// answer the ticks of the wrong simulator.
#pragma once

#include "common/bus/channel_names.hpp"

#include <string>

namespace waymark {

/// Held during the object's lifetime; the system releases it however the process ends. Simulators
/// on another port, or with another network name of TICK, are not excluded; on networks other than
/// udpm nothing is locked.
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
