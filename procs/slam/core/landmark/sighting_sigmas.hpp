// SPDX-License-Identifier: BSD-3-Clause
// How good camera and markers are.
#pragma once

#include <Eigen/Core>

namespace waymark {

/// How far camera and markers may differ from their description: standard
/// deviations. Keys and meanings: [robot.camera] and [robot.markers]; the defaults are theirs.
struct SightingSigmas {
  /// Indices into `learnt`.
  static constexpr Eigen::Index kYaw = 0;
  static constexpr Eigen::Index kFocal = 1;
  static constexpr Eigen::Index kStandoff = 2;

  /// Of what all sightings get wrong in the same way: mounting's yaw [rad], focal length
  /// (relative), standoff of the markers [m]. Learnt while driving; one of 0 is not.
  Eigen::Vector3d learnt{0.0087, 0.002, 0.003};
  double bearing_rad{0.0001};
  double position_m{0.0003};
  double bulge_m{0.002};
  double skew_rad{0.01};
};

}  // namespace waymark
