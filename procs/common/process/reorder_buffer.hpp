// SPDX-License-Identifier: BSD-3-Clause
// Puts messages that arrive a little out of order back into order (real time only).
#pragma once

#include "common/messages/message.hpp"
#include "common/process/node.hpp"

#include <set>
#include <vector>

namespace waymark {

/// Holds messages until one is `window` newer, then releases them by (time, channel, payload). What
/// comes later than something already released is dropped and counted; so is what jumps absurdly
/// ahead, which would make everything after it late.
class ReorderBuffer {
 public:
  explicit ReorderBuffer(Duration window);

  std::vector<Message> add(Message message, Counters& counters);
  /// Everything that waits, e.g. when nothing has come for a while.
  std::vector<Message> flush();

 private:
  struct Before {
    bool operator()(const Message& a, const Message& b) const { return comes_before(a, b); }
  };

  std::vector<Message> release_until(Timestamp time);

  Duration window_;
  std::set<Message, Before> waiting_;
  Timestamp newest_{};
  Timestamp released_{};
  bool has_any_{false};
};

}  // namespace waymark
