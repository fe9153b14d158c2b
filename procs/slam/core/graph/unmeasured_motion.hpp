// SPDX-License-Identifier: BSD-3-Clause
// Motion that the odometry does not measure, because it stands still or jumps while the robot
// drives.
#pragma once

#include "slam/core/scan/observation.hpp"

namespace waymark {

/// When the odometry stands still, the robot nearly always does, too. If markers or walls observe
/// that the robot moves, the odometry is stuck until it shows motion again; if nothing is observed,
/// the odometry may be stuck. Meanwhile the robot may have continued at its last speed.
class UnmeasuredMotion {
 public:
  /// To be called with each observation.
  void follow(const Observation& observation);

  /// Markers or walls have just observed the motion.
  void note_observed() {
    silent_s_ = 0.0;
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

  /// The odometry is known to be wrong at present.
  bool is_silent() const { return is_stuck_ || is_jumping_; }

  /// Distance that may have been driven while the odometry was silent, one sigma.
  double unmeasured_m() const { return speed_m_s_ * silent_s_; }

  /// Returns unmeasured_m() and resets it to zero: from now on a factor of the graph accounts for
  /// it.
  double take_unmeasured_m();

  /// Distance that may have been driven since the odometry came to a standstill, one sigma. Since
  /// the robot probably stands, it is added to published covariances only, not to the graph.
  double suspected_m() const;

 private:
  double speed_m_s_{0.0};   ///< from odometry or, while that is stuck, from the estimate
  double silent_s_{0.0};    ///< since the motion was last observed
  double standing_s_{0.0};  ///< time standing and not silent
  bool is_standing_{false};
  bool is_stuck_{false};
  bool is_jumping_{false};
};

}  // namespace waymark
