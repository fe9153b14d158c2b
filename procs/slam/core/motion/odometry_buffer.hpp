// SPDX-License-Identifier: BSD-3-Clause
// The odometry of the last seconds, readable at any time in between.
#pragma once

#include "common/sensors/sensors.hpp"
#include "common/time/clock_step_detector.hpp"
#include "slam/core/motion/motion.hpp"

#include <deque>
#include <optional>

namespace waymark {

class OdometryBuffer {
 public:
  /// How a sample was taken.
  enum class Outcome { kAdded, kOutOfOrder, kTooFarAhead, kJumped, kCaughtUp };

  /// A sample that is not newer than the last is refused, and one that is newer by more than any
  /// pause (ClockStepDetector::kLongestPause). Odometry that stood still and then jumps as far as
  /// can be driven meanwhile had been stuck: the jump is what it has kept back. After a jump that
  /// no robot can drive nothing is believed until some samples in a row agree: if they are where
  /// the robot can have driven since the jump, what came in between was garbage, and the way from
  /// before it is what was kept back; else the odometry was reset, which is no motion.
  Outcome add(const OdometrySample& sample);

  bool is_empty() const { return samples_.empty(); }

  bool has_one() const { return samples_.size() == 1; }

  bool covers(Timestamp time) const {
    return !samples_.empty() && samples_.front().time <= time && time <= samples_.back().time;
  }

  /// Interpolated, without jumps; needs covers(time).
  Se2 pose_at(Timestamp time) const;

  /// The same as it was sent, with jumps.
  Se2 sent_pose_at(Timestamp time) const;

  /// Along the path of the samples, without what kept_back() reports. Needs both times covered,
  /// from <= to.
  Motion motion_between(Timestamp from, Timestamp to) const;

  /// Motion that a sample in (from, to] has reported late, after odometry was stuck or jumped.
  std::optional<Motion> kept_back(Timestamp from, Timestamp to) const;

  /// Whether samples of that time are not believed.
  bool is_doubtful(Timestamp from, Timestamp to) const {
    return doubted_ && doubted_->from < to && from < doubted_->to;
  }

  /// Of the first sample that is not before that time.
  std::optional<Timestamp> first_from(Timestamp time) const;

  Timestamp newest() const { return samples_.back().time; }

  /// As if every sample had been taken so much later.
  void shift(Duration later);

  /// Forgets what is not needed to read at `time` or later.
  void forget_before(Timestamp time);

 private:
  struct Sample {
    Timestamp time{};
    Se2 odom_from_base{};  ///< without jumps
    Se2 smooth_from_raw{};
  };

  /// What was kept back since the odometry last changed.
  struct CatchUp {
    Timestamp time{};  ///< of the sample that reported it
    Motion motion{};
  };

  /// Since a jump.
  struct Doubt {
    OdometrySample before{};  ///< the jump
    Se2 begin{};              ///< of the samples that agree
    int agreeing{0};
  };

  struct Interval {
    Timestamp from{};
    Timestamp to{};
  };

  std::deque<Sample>::const_iterator sample_from(Timestamp time) const;
  Outcome add_newer(const OdometrySample& sample);
  Outcome weigh(const OdometrySample& sample, bool jumps);
  bool has_kept_back(const Se2& step, const OdometrySample& sample) const;

  static constexpr double kMaxSpeed_m_s = 10.0;       ///< faster is a reset, not a drive
  static constexpr double kMaxTurnRate_rad_s = 20.0;  ///< same for turning
  static constexpr double kMaxDrive_m_s = 2.0;        ///< on average, while it was stuck
  static constexpr double kMaxDrive_rad_s = 2.0;      ///< same for turning
  static constexpr int kAgreeing = 4;                 ///< samples that end a doubt
  static constexpr std::size_t kMaxSamples = 20000;   ///< 10 minutes at 30 Hz, if nobody forgets

  std::deque<Sample> samples_{};
  Se2 smooth_from_raw_{};
  Se2 last_raw_{};
  Timestamp changed_{};  ///< when its pose last changed
  std::optional<CatchUp> catch_up_{};
  std::optional<Doubt> doubt_{};
  std::optional<Interval> doubted_{};  ///< the last one, perhaps still going on
};

}  // namespace waymark
