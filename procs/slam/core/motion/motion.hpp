// SPDX-License-Identifier: BSD-3-Clause
// Motion of the robot between two times, measured by odometry.
#pragma once

#include "common/geometry/se2.hpp"

#include <cmath>

namespace waymark {

/// Distances and turns are summed over the steps: noise depends on the path that was driven, not on
/// the number of steps or the distance between the ends.
struct Motion {
  Se2 start_from_end{};    ///< pose at the end in the base frame at the start
  double distance_m{0.0};  ///< length of the path
  double turn_rad{0.0};    ///< sum of absolute turns
  double guessed_s{0.0};   ///< time in which odometry was rejected and the motion extrapolated
  double advance_m{0.0};   ///< like `distance_m`, but driving backwards counts negative

  /// The motion of one step.
  static Motion between(const Se2& odom_from_start, const Se2& odom_from_end) {
    const Se2 step = odom_from_start.inverse() * odom_from_end;
    const double distance_m = step.translation().norm();
    return {step, distance_m, std::abs(step.theta()), 0.0, std::copysign(distance_m, step.x())};
  }

  /// First this motion, then `next`.
  Motion then(const Motion& next) const {
    return {start_from_end * next.start_from_end, distance_m + next.distance_m,
            turn_rad + next.turn_rad, guessed_s + next.guessed_s, advance_m + next.advance_m};
  }
};

}  // namespace waymark
