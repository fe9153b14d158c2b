// SPDX-License-Identifier: BSD-3-Clause
// Puts messages that arrive a little out of order back into order (real time only).
#pragma once

#include "common/messages/message.hpp"
#include "common/node/node.hpp"
#include "common/time/clock_step_detector.hpp"

#include <cstddef>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

namespace waymark {

/// Whether it is a command without a stamp of its own (utime 0), or slam's reply to one.
bool is_unstamped(const Message& message);

/// Holds messages until one is `window` newer, then releases them by (time, channel, payload).
/// Drops and counts messages older than a released one of their channel, and messages more than
/// ClockStepDetector::kLongestPause ahead of the newest one, which would release all others. Many
/// of these in a row with consistent stamps mean that the clock was set: the waiting messages are
/// released, and the order begins anew. A channel may lag by more than the window, as computed
/// results do.
///
/// A message moderately far ahead of all channels is set aside: either there was a pause, or its
/// stamp is wrong. The next message of its channel decides: a newer one confirms it, an older one
/// drops it.
///
/// Commands and replies without a stamp of their own are released at once.
///
/// Memory is bounded, also with a sender whose clock stands still: further messages that would be
/// set aside are dropped, and when too many wait, the oldest are released.
class ReorderBuffer {
 public:
  // Far more than our processes send: few messages share a stamp, some tens arrive per window.
  static constexpr std::size_t kMaxSetAside = 100;  ///< per channel, all with one stamp
  static constexpr std::size_t kMaxWaiting = 2000;  ///< of all channels

  explicit ReorderBuffer(Duration window);

  std::vector<Message> add(Message message, Counters& counters);
  /// Releases everything, e.g. when no message has come for a while.
  std::vector<Message> flush();

 private:
  struct Before {
    bool operator()(const Message& a, const Message& b) const { return comes_before(a, b); }
  };

  /// Why a message cannot be put into order: older than a released one of its channel (kLate), or
  /// too far ahead of the newest message (kAhead).
  enum class OrderProblem { kNone, kLate, kAhead };

  // A message more than this ahead of all others may be set aside, which delays it by a period of
  // its channel. Longer than odometry's default period and the jitter between processes.
  static constexpr Duration kLead = std::chrono::milliseconds{100};
  static constexpr Duration kLongestStep = std::chrono::milliseconds{500};

  /// What is known of a channel.
  struct Stream {
    std::optional<Timestamp> newest{};    ///< newest stamp that was put into waiting_
    std::optional<Timestamp> released{};  ///< stamp of the last released message
    Duration usual_step{kLongestStep};    ///< last step between stamps; at most doubles at once
    std::vector<Message> aside{};         ///< messages set aside, all with one stamp
  };

  OrderProblem order_problem_of(const Message& message) const;
  Message stamped(Message message) const;
  bool leads(const Stream& stream, Timestamp time) const;
  void resolve_aside(Stream& stream, Timestamp time, Counters& counters);
  void put_into_order(Stream& stream, Message message);
  std::vector<Message> begin_anew(Message message);
  std::vector<Message> release_until(Timestamp time);

  Duration window_;
  std::set<Message, Before> waiting_;
  Timestamp newest_{};
  std::map<std::string, Stream, std::less<>> streams_;
  ClockStepDetector clock_steps_;
  bool has_any_{false};
};

}  // namespace waymark
