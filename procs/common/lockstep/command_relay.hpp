// SPDX-License-Identifier: BSD-3-Clause
// Assigns commands from outside to a tick of the lockstep.
#pragma once

#include "common/messages/message.hpp"
#include "common/node/node.hpp"

#include <vector>

namespace waymark {

/// A SLAM_COMMAND comes at any time, but must act in the same tick for everybody, and for every
/// replay: the simulator puts it into the next tick that it opens, stamped with that tick's end.
class CommandRelay {
 public:
  static constexpr std::size_t kMostPerTick = 10;

  explicit CommandRelay(Counters& counters) : counters_{counters} {}

  /// Ignores commands that it has published itself in a tick.
  void take(const Message& message);

  /// Adds the commands that wait to the messages of a tick.
  void move_into(std::vector<Message>& tick, Timestamp tick_end);

 private:
  Counters& counters_;
  std::vector<Message> waiting_{};
};

}  // namespace waymark
