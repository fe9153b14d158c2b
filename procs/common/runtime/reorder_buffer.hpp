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

/// Holds messages until one is `window` newer, then releases them by (time, channel, payload). A
/// channel may lag behind the others by more than the window, as computed results do. Drops and
/// counts messages that are older than a released one of their channel, and messages more than
/// ClockStepDetector::kLongestPause ahead of the newest one, which would release all others. When
/// many of these agree, the clock was set: the order begins anew with the latest of them.
///
/// A message moderately far ahead of all channels is set aside: either there was a pause, or its
/// stamp is wrong. The next message of its channel decides: a newer one confirms it, an older one
/// drops it.
///
/// Memory is bounded, also with a sender whose clock stands still: at most kMostAside messages of
/// one stamp are set aside, and when more than kMostWaiting wait, the oldest are released.
class ReorderBuffer {
 public:
  // Our processes send few messages of one stamp, and some tens within a window.
  static constexpr std::size_t kMostAside = 100;  ///< of each channel
  static constexpr std::size_t kMostWaiting = 2000;

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
  enum class Misfit { kNone, kLate, kAhead };

  // A message more than this ahead of all others may be set aside, which delays it by a period of
  // its channel. Above odometry's default period and the jitter between processes.
  static constexpr Duration kLead = std::chrono::milliseconds{100};
  static constexpr Duration kLongestStep = std::chrono::milliseconds{500};

  /// What is known of a channel.
  struct Stream {
    std::optional<Timestamp> newest{};    ///< newest stamp that was put into waiting_
    std::optional<Timestamp> released{};  ///< stamp of the last released message
    Duration usual_step{kLongestStep};    ///< between the last two stamps; at most doubles
    std::vector<Message> aside{};         ///< set aside; all of one stamp
  };

  Misfit misfit(const Message& message) const;
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
