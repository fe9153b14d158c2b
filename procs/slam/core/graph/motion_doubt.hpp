// SPDX-License-Identifier: BSD-3-Clause
// Motion that the odometry does not measure: it stands still, or jumps about, while the robot
// drives.
#pragma once

#include "slam/core/scan/observation.hpp"

namespace waymark {

/// Odometry that stands still nearly always belongs to a robot that stands. Where markers or walls
/// show that it moves, the odometry is stuck until it moves again; where nothing shows anything, it
/// may be. Meanwhile the robot may have gone on as fast as before.
class MotionDoubt {
 public:
  /// The next observation.
  void follow(const Observation& observation);

  /// Markers or walls showed the way just now.
  void note_observed() {
    silent_s_ = 0.0;
    standing_s_ = 0.0;
  }

  /// They showed that the robot moved so far in that time, and the odometry stood still.
  void note_moved(double distance_m, double elapsed_s);

  bool is_standing() const { return is_standing_; }

  /// The odometry of just now is known to say nothing.
  bool is_silent() const { return is_stuck_ || is_jumping_; }

  /// What may have been driven while odometry was silent, one sigma.
  double unmeasured_m() const { return speed_m_s_ * silent_s_; }

  /// The same, for a factor that holds it from now on.
  double take_unmeasured_m();

  /// The same of odometry that is probably right to stand still; it is never in the graph.
  double suspected_m() const;

 private:
  double speed_m_s_{0.0};  ///< by odometry, or, where that is stuck, by the estimate
  double silent_s_{0.0};
  double standing_s_{0.0};  ///< and not silent
  bool is_standing_{false};
  bool is_stuck_{false};
  bool is_jumping_{false};
};

}  // namespace waymark
