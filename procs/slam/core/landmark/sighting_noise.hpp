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

  /// Standard deviations of the systematic errors, which are estimated with the calibration (0:
  /// known exactly): camera yaw [rad], focal length (relative), distance of markers from their
  /// walls [m].
  Eigen::Vector3d calibration{0.0087, 0.002, 0.003};
  double bearing_rad{0.0001};  ///< bearing error common to neighbouring frames
  double position_m{0.0003};   ///< position error common to neighbouring frames
  double bulge_m{0.002};       ///< spread of the markers' distances from their walls
  double skew_rad{0.01};       ///< angle between a marker and its wall
};

}  // namespace waymark
