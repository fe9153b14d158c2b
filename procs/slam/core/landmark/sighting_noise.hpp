// SPDX-License-Identifier: BSD-3-Clause
// Accuracy of camera and markers.
#pragma once

#include <Eigen/Core>

namespace waymark {

/// Standard deviations of camera and markers from their description. Keys and meanings:
/// [robot.camera] and [robot.markers].
struct SightingNoise {
  /// Indices into `calibration`.
  static constexpr Eigen::Index kYaw = 0;
  static constexpr Eigen::Index kFocal = 1;
  static constexpr Eigen::Index kStandoff = 2;

  /// Priors of the systematic errors, which are estimated as part of the calibration (0: exact):
  /// yaw of the mounting [rad], focal length (relative), standoff of the markers [m].
  Eigen::Vector3d calibration{0.0087, 0.002, 0.003};
  double bearing_rad{0.0001};
  double position_m{0.0003};
  double bulge_m{0.002};
  double skew_rad{0.01};
};

}  // namespace waymark
