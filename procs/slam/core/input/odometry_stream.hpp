// SPDX-License-Identifier: BSD-3-Clause
// Odometry as it arrives: the clock of all other sensors.
#pragma once

#include "common/sensors/sensors.hpp"
#include "common/time/clock_step_detector.hpp"
#include "slam/core/input/skip.hpp"
#include "slam/core/motion/odometry_buffer.hpp"

#include <optional>

namespace waymark {

/// A sample that comes more than two usual steps after the one before may be stamped wrong. It is
/// held back ("leading") until a newer one confirms it; until then its time has not been reached.
class OdometryStream {
 public:
  /// What other sensors have to know of a sample.
  struct News {
    bool is_first{false};                 ///< it is the first: from now on stamps can be judged
    std::optional<Duration> clock_set{};  ///< by so much: stamps from before are worth nothing
  };

  News add(const OdometrySample& sample, Skips& skips);

  /// No more samples will come: the one that leads counts.
  void finish(Skips& skips);

  bool has_passed(Timestamp time) const { return !buffer_.is_empty() && buffer_.newest() >= time; }

  /// Including the one that leads; needs a sample.
  Timestamp newest() const { return leading_ ? leading_->time : buffer_.newest(); }

  /// What another sensor stamps later than this is wrong. Sensors may wait for odometry that comes
  /// in bursts; needs a sample.
  Timestamp lead_limit() const { return newest() + kLongestLead; }

  bool is_ahead(Timestamp time) const { return !buffer_.is_empty() && time > lead_limit(); }

  const OdometryBuffer& buffer() const { return buffer_; }

  /// What is older will not be read any more.
  void forget_before(Timestamp time) {
    has_been_read_ = true;
    buffer_.forget_before(time);
  }

 private:
  News take(const OdometrySample& sample, Skips& skips);
  void weigh_leading(const OdometrySample& sample, Skips& skips);
  bool leads(const OdometrySample& sample) const;
  bool shows_first_was_ahead(const OdometrySample& sample) const;
  Duration set_clock(Skips& skips);

  static constexpr Duration kLongestLead = std::chrono::seconds{10};
  static constexpr Duration kLongestStep{500'000};

  OdometryBuffer buffer_{};
  ClockStepDetector clock_steps_{};
  Duration usual_step_{kLongestStep};  ///< twice as long may be usual, too
  std::optional<OdometrySample> leading_{};
  bool has_been_read_{false};
};

}  // namespace waymark
