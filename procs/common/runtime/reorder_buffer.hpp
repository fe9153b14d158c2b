// SPDX-License-Identifier: BSD-3-Clause
// Puts messages that arrive a little out of order back into order (real time only).
#pragma once

#include "common/messages/message.hpp"
#include "common/node/node.hpp"
#include "common/time/clock_watch.hpp"

#include <map>
#include <set>
#include <string>
#include <vector>

namespace waymark {

/// Holds messages until one is `window` newer, then releases them by (time, channel, payload). A
/// channel may lag behind the others by more, as what is computed from them does. Dropped and
/// counted is what comes later than something newer of its own channel, and what jumps absurdly
/// ahead, which would let nothing else wait; unless the clock was set.
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

  /// How a message does not fit what came before.
  enum class Misfit { kNone, kLate, kAhead };

  Misfit misfit(const Message& message) const;
  Message stamped(Message message) const;
  std::vector<Message> begin_anew(Message message);
  std::vector<Message> release_until(Timestamp time);

  Duration window_;
  std::set<Message, Before> waiting_;
  Timestamp newest_{};
  std::map<std::string, Timestamp, std::less<>> released_;  ///< newest of each channel
  ClockWatch clock_watch_;
  bool has_any_{false};
};

}  // namespace waymark
