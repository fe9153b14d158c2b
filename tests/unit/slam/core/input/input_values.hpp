// SPDX-License-Identifier: BSD-3-Clause
// Small sensor values for tests of the input: a robot that drives a metre in 10 s.
#pragma once

#include "slam/core/input/sensor_queue.hpp"

#include <vector>

namespace waymark::test {

inline Timestamp at_ms(int milliseconds) {
  return Timestamp{std::chrono::milliseconds{milliseconds}};
}

inline MarkerDetections frame_at(int milliseconds, std::vector<double> columns_px) {
  MarkerDetections frame;
  frame.time = at_ms(milliseconds);
  for (const double column_px : columns_px) {
    MarkerDetection detection;
    detection.id = static_cast<int>(frame.detections.size());
    detection.corners_px[0].x() = column_px;
    frame.detections.push_back(detection);
  }
  return frame;
}

inline OdometrySample odometry_at(int milliseconds) {
  return {at_ms(milliseconds), Se2{1e-4 * milliseconds, 0.0, 0.0}};
}

inline LidarScan scan_at(int milliseconds) {
  LidarScan scan;
  scan.time = at_ms(milliseconds);
  scan.angles_rad = {0.0, 0.1, 0.2};
  scan.ranges_m = {1.0, 1.0, 1.0};
  return scan;
}

}  // namespace waymark::test
