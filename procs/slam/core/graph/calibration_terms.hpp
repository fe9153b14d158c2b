// SPDX-License-Identifier: BSD-3-Clause
// Names and units of the calibration's terms, for logs and files.
#pragma once

#include "slam/core/graph/state.hpp"

#include <array>
#include <string_view>

namespace waymark {

struct CalibrationTerm {
  std::string_view key;
  std::string_view name;
  std::string_view unit;
  double per_unit;  ///< factor from Calibration's value to `unit`
};

/// In the order of Calibration.
inline constexpr std::array<CalibrationTerm, kCalibrationSize> kCalibrationTerms{
    {{"odometry_scale", "odometry's distances", "%", 100.0},
     {"odometry_drift_rad_per_m", "odometry's drift", "rad/m", 1.0},
     {"odometry_turn_scale", "odometry's turns", "%", 100.0},
     {"lidar_ahead_m", "LiDAR ahead", "m", 1.0},
     {"lidar_yaw_rad", "LiDAR yaw", "rad", 1.0},
     {"camera_yaw_rad", "camera yaw", "rad", 1.0},
     {"focal_length", "focal length", "%", 100.0},
     {"marker_standoff_m", "standoff of markers", "m", 1.0}}};

}  // namespace waymark
