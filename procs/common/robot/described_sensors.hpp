// SPDX-License-Identifier: BSD-3-Clause
// Measurements as an upright sensor with odometry's clock would have sent them.
#pragma once

#include "common/robot/robot_config.hpp"
#include "common/sensors/sensors.hpp"

namespace waymark {

/// @param scan  as it comes from the LiDAR that is described; angles of a mirrored one count
///              clockwise.
/// @return angles counter-clockwise, stamped by odometry's clock
inline LidarScan as_described(LidarScan scan, const LidarConfig& lidar) {
  scan.time -= duration_from_seconds(lidar.late_s);
  if (lidar.mirrored) {
    for (double& angle_rad : scan.angles_rad)
      angle_rad = -angle_rad;
  }
  return scan;
}

/// Stamped by odometry's clock.
inline MarkerDetections as_described(MarkerDetections frame, const CameraConfig& camera) {
  frame.time -= duration_from_seconds(camera.late_s);
  return frame;
}

}  // namespace waymark
