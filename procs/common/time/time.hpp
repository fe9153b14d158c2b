// SPDX-License-Identifier: BSD-3-Clause
// Message time: microseconds on the clock that stamps all messages. Cores use no other clock.
#pragma once

#include <chrono>
#include <cstdint>

namespace waymark {

using Duration = std::chrono::microseconds;

/// Tag of the message clock. It cannot be asked for "now": time comes in messages only.
struct MessageClock {
  using duration = Duration;
  using rep = duration::rep;
  using period = duration::period;
  using time_point = std::chrono::time_point<MessageClock>;
};

using Timestamp = MessageClock::time_point;

/// The time that a message field `utime` [us] stands for.
constexpr Timestamp timestamp_from_us(std::int64_t utime_us) {
  return Timestamp{Duration{utime_us}};
}

constexpr std::int64_t to_us(Timestamp time) {
  return time.time_since_epoch().count();
}

constexpr double to_seconds(Duration duration) {
  return static_cast<double>(duration.count()) * 1e-6;
}

constexpr double to_seconds(Timestamp time) {
  return to_seconds(time.time_since_epoch());
}

/// Nearest duration of whole microseconds.
constexpr Duration duration_from_seconds(double seconds) {
  return Duration{static_cast<std::int64_t>(seconds * 1e6 + (seconds < 0 ? -0.5 : 0.5))};
}

}  // namespace waymark
