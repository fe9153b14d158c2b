// SPDX-License-Identifier: BSD-3-Clause
// Recent odometry, interpolated at any time.
#pragma once

#include "common/sensors/sensors.hpp"
#include "common/time/clock_step_detector.hpp"
#include "slam/core/motion/motion.hpp"

#include <deque>
#include <optional>

namespace waymark {

class OdometryBuffer {
 public:
  /// What add() made of a sample.
  enum class Outcome { kAdded, kOutOfOrder, kTooFarAhead, kJumped, kCaughtUp };

  /// Refuses a sample that is not newer than the last one, or newer by more than
  /// ClockStepDetector::kLongestPause.
  ///
  /// Stuck odometry: the pose did not change, then changes in one step by no more than the robot
  /// can have driven meanwhile. That is real motion, reported late: late_motion().
  ///
  /// Jump: a step that no robot can drive, or one to odometry's origin, also after a gap. The pose
  /// is held until some samples in a row are consistent. If the robot can have driven to them from
  /// the pose before the jump, the motion is late motion; otherwise odometry was reset: no motion.
  Outcome add(const OdometrySample& sample);

  bool is_empty() const { return samples_.empty(); }

  bool has_one() const { return samples_.size() == 1; }

  bool covers(Timestamp time) const {
    return !samples_.empty() && samples_.front().time <= time && time <= samples_.back().time;
  }

  /// Interpolated, with jumps removed; needs covers(time).
  Se2 pose_at(Timestamp time) const;

  /// Interpolated, in the frame in which the samples were sent, jumps included; needs covers(time).
  Se2 sent_pose_at(Timestamp time) const;

  /// Along the path of the samples, without late_motion(). Needs both times covered, from <= to.
  Motion motion_between(Timestamp from, Timestamp to) const;

  /// Motion that a sample in (from, to] reported at once, after odometry was stuck or had jumped.
  std::optional<Motion> late_motion(Timestamp from, Timestamp to) const;

  /// Whether the pose was held after a jump at some time in (from, to).
  bool has_jumped(Timestamp from, Timestamp to) const {
    return jump_interval_ && jump_interval_->from < to && from < jump_interval_->to;
  }

  /// Time of the first sample at or after `time`.
  std::optional<Timestamp> first_from(Timestamp time) const;

  Timestamp newest() const { return samples_.back().time; }

  /// Adds to the time of every sample.
  void shift(Duration later);

  /// Drops samples that are not needed to read at `time` or later.
  void forget_before(Timestamp time);

 private:
  struct Sample {
    Timestamp time{};
    Se2 odom_from_base{};   ///< without jumps
    Se2 smooth_from_raw{};  ///< transform that removes the jumps so far
  };

  /// Late motion.
  struct CatchUp {
    Timestamp time{};  ///< when it was reported
    Motion motion{};
  };

  /// A jump that is not explained yet.
  struct Jump {
    OdometrySample before{};  ///< the last sample before it
    Se2 begin{};              ///< odom_from_base at the first of the consistent samples
    int consistent{0};        ///< consistent samples after that one
  };

  struct Interval {
    Timestamp from{};
    Timestamp to{};
  };

  std::deque<Sample>::const_iterator sample_from(Timestamp time) const;
  Outcome add_newer(const OdometrySample& sample);
  Outcome resolve_jump(const OdometrySample& sample, bool jumps);
  bool is_catching_up(const Se2& step, const OdometrySample& sample) const;

  static constexpr double kMaxSpeed_m_s = 10.0;       ///< faster is a reset, not a drive
  static constexpr double kMaxTurnRate_rad_s = 20.0;  ///< same for turning
  static constexpr double kStood_s = 0.5;       ///< a jump after a longer standstill is late motion
  static constexpr double kReset_m = 0.25;      ///< a longer step to the origin is a reset
  static constexpr double kReset_rad = 0.5;     ///< same for turning
  static constexpr double kMaxDrive_m_s = 2.0;  ///< largest mean speed of late motion
  static constexpr double kMaxDrive_rad_s = 2.0;     ///< same for turning
  static constexpr int kConsistentSamples = 4;       ///< samples that end a jump
  static constexpr std::size_t kMaxSamples = 20000;  ///< 10 minutes at 30 Hz

  std::deque<Sample> samples_{};
  Se2 smooth_from_raw_{};
  Se2 last_raw_{};
  Timestamp changed_{};  ///< when the pose last changed
  std::optional<CatchUp> catch_up_{};
  std::optional<Jump> jump_{};
  std::optional<Interval> jump_interval_{};  ///< of the last jump, which may not be over yet
};

}  // namespace waymark
