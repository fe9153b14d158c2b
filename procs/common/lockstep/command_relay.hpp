// SPDX-License-Identifier: BSD-3-Clause
// Assigns commands from outside to a tick of the lockstep.
#pragma once

#include "common/messages/message.hpp"
#include "common/node/node.hpp"

#include <vector>

namespace waymark {

/// A SLAM_COMMAND arrives at any time, but must act in the same tick in every process and in every
/// replay: the simulator puts it into the next tick that it opens, stamped with that tick's end.
class CommandRelay {
 public:
  static constexpr std::size_t kMaxPerTick = 10;

  explicit CommandRelay(Counters& counters) : counters_{counters} {}

  /// Keeps a SLAM_COMMAND for the next tick; ignores commands that are already part of a tick.
  void handle(const Message& message);

  /// Moves the waiting commands into the messages of a tick.
  void move_into(std::vector<Message>& tick, Timestamp tick_end);

 private:
  Counters& counters_;
  std::vector<Message> waiting_{};
};

}  // namespace waymark
