// SPDX-License-Identifier: BSD-3-Clause
// Corrects measurements for what robot.toml states of the sensor: delay, mirrored mounting.
#pragma once

#include "common/robot/robot_config.hpp"
#include "common/sensors/sensors.hpp"

namespace waymark {

/// @param scan  raw; the angles of a mirrored LiDAR count clockwise.
/// @return the scan with angles counter-clockwise, stamped on odometry's clock.
inline LidarScan as_described(LidarScan scan, const LidarConfig& lidar) {
  scan.time -= duration_from_seconds(lidar.late_s);
  if (lidar.mirrored) {
    for (double& angle_rad : scan.angles_rad)
      angle_rad = -angle_rad;
  }
  return scan;
}

/// @return the detections, stamped on odometry's clock.
inline MarkerDetections as_described(MarkerDetections frame, const CameraConfig& camera) {
  frame.time -= duration_from_seconds(camera.late_s);
  return frame;
}

}  // namespace waymark
