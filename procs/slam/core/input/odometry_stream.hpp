// SPDX-License-Identifier: BSD-3-Clause
// Odometry as it arrives, against which the stamps of all other sensors are checked.
#pragma once

#include "common/sensors/sensors.hpp"
#include "common/time/clock_step_detector.hpp"
#include "slam/core/input/skip.hpp"
#include "slam/core/motion/odometry_buffer.hpp"

#include <optional>

namespace waymark {

/// A sample that is more than two usual steps newer than the one before may have a wrong stamp. It
/// is held back until a newer one confirms it; until then it does not count as received.
class OdometryStream {
 public:
  /// Consequences of a sample for the other sensors' queues.
  struct News {
    bool is_first{false};  ///< first of all samples: stamps can be checked from now on
    /// The clock was set by this: older stamps are invalid.
    std::optional<Duration> clock_set{};
  };

  News add(const OdometrySample& sample, Skips& skips);

  /// To be called after the last sample: accepts the sample that is held back.
  void finish(Skips& skips);

  bool has_passed(Timestamp time) const { return !buffer_.is_empty() && buffer_.newest() >= time; }

  /// Stamp of the newest sample, one that is held back included; needs a sample.
  Timestamp newest() const { return held_ ? held_->time : buffer_.newest(); }

  /// Latest plausible stamp of another sensor: odometry may arrive in bursts, so that other
  /// messages are ahead of it. A later stamp needs confirmation by the next sample. Needs a sample.
  Timestamp lead_limit() const { return newest() + kLongestLead; }

  bool is_ahead(Timestamp time) const { return !buffer_.is_empty() && time > lead_limit(); }

  const OdometryBuffer& buffer() const { return buffer_; }

  /// Drops samples that are not needed to read at `time` or later.
  void forget_before(Timestamp time) {
    has_been_read_ = true;
    buffer_.forget_before(time);
  }

 private:
  News accept(const OdometrySample& sample, Skips& skips);
  void resolve_held(const OdometrySample& sample, Skips& skips);
  bool is_to_be_held(const OdometrySample& sample) const;
  bool shows_first_was_ahead(const OdometrySample& sample) const;
  Duration set_clock(Skips& skips);

  static constexpr Duration kLongestLead = std::chrono::seconds{10};
  static constexpr Duration kLongestStep{500'000};

  OdometryBuffer buffer_{};
  ClockStepDetector clock_steps_{};
  Duration usual_step_{kLongestStep};     ///< between samples; at most doubles from one to the next
  std::optional<OdometrySample> held_{};  ///< sample that is held back
  bool has_been_read_{false};             ///< forget_before() was called: observations were made
};

}  // namespace waymark
