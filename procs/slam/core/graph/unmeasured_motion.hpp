// SPDX-License-Identifier: BSD-3-Clause
// Motion that the odometry does not measure, because it stands still or jumps while the robot
// drives.
#pragma once

#include "slam/core/scan/observation.hpp"

namespace waymark {

/// When odometry stands still, the robot nearly always stands. When markers or walls observe that
/// it moves, the odometry is stuck until it moves again; when nothing is observed, it may be stuck.
/// Meanwhile the robot may have gone on at its last speed.
class UnmeasuredMotion {
 public:
  /// The next observation.
  void follow(const Observation& observation);

  /// Markers or walls have just observed the motion.
  void note_observed() {
    silent_s_ = 0.0;
    standing_s_ = 0.0;
  }

  /// They observed that the robot moved so far in that time, while the odometry stood still.
  void note_moved(double distance_m, double elapsed_s);

  /// The robot has returned to where the odometry came to a standstill: both stand still.
  void note_returned() {
    is_stuck_ = false;
    note_observed();
  }

  bool is_standing() const { return is_standing_; }

  /// The present odometry is known to be wrong.
  bool is_silent() const { return is_stuck_ || is_jumping_; }

  /// Distance that may have been driven while odometry was silent, one sigma.
  double unmeasured_m() const { return speed_m_s_ * silent_s_; }

  /// The same, and sets it to zero: from now on a factor of the graph holds it.
  double take_unmeasured_m();

  /// Distance that may have been driven since odometry came to a standstill, which is probably
  /// right; one sigma. Added to published covariances only, never to the graph.
  double suspected_m() const;

 private:
  double speed_m_s_{0.0};   ///< by odometry, or, while that is stuck, by the estimate
  double silent_s_{0.0};    ///< since the motion was last observed
  double standing_s_{0.0};  ///< standing and not silent
  bool is_standing_{false};
  bool is_stuck_{false};
  bool is_jumping_{false};
};

}  // namespace waymark
