// SPDX-License-Identifier: BSD-3-Clause
// Motion that the odometry does not measure, because it stands still or jumps while the robot
// drives.
#pragma once

#include "slam/core/scan/observation.hpp"

namespace waymark {

/// When the odometry stands still, the robot nearly always does, too. If markers or walls observe
/// that the robot moves, the odometry is stuck until it shows motion again; if nothing observes the
/// motion, the odometry may be stuck. Meanwhile the robot may have continued at its last speed.
class UnmeasuredMotion {
 public:
  /// To be called with each observation.
  void follow(const Observation& observation);

  /// Markers or walls have just observed the motion.
  void note_observed() {
    unreliable_s_ = 0.0;
    standing_s_ = 0.0;
  }

  /// Markers or walls have observed that the robot moved by `distance_m` in `elapsed_s`. If the
  /// odometry stands still, it is stuck.
  void note_moved(double distance_m, double elapsed_s);

  /// The robot is back where the odometry came to a standstill: the odometry is not stuck.
  void note_returned() {
    is_stuck_ = false;
    note_observed();
  }

  bool is_standing() const { return is_standing_; }

  /// Odometry is known to be wrong: stuck while the robot moves, or jumping.
  bool is_unreliable() const { return is_stuck_ || is_jumping_; }

  /// Standard deviation of the distance driven while odometry was unreliable.
  double unmeasured_m() const { return speed_m_s_ * unreliable_s_; }

  /// Returns unmeasured_m() and resets it to zero: from now on a factor of the graph accounts for
  /// that motion.
  double take_unmeasured_m();

  /// Standard deviation of the distance driven since odometry came to a standstill, in case it is
  /// stuck. For published covariances only, not for the graph: the robot probably stands.
  double possibly_stuck_m() const;

 private:
  double speed_m_s_{0.0};     ///< from odometry or, while that is stuck, from the estimate
  double unreliable_s_{0.0};  ///< duration since the motion was last observed
  double standing_s_{0.0};    ///< duration of the standstill while odometry may be right
  bool is_standing_{false};
  bool is_stuck_{false};
  bool is_jumping_{false};
};

}  // namespace waymark
