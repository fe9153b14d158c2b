// SPDX-License-Identifier: BSD-3-Clause
// Message types <-> the cores' plain values. From-conversions expect messages that decode()
// accepted.
#pragma once

#include "common/messages/channels.hpp"
#include "common/sensors/sensors.hpp"

namespace waymark {

LidarScan to_scan(const planar_lidar_t& message);
/// MBot's clockwise angles become counter-clockwise; range 0 (its "no return") becomes +inf;
/// per-beam times become offsets.
LidarScan to_scan(const lidar_t& message);
/// The beams must be evenly spaced. @throws std::logic_error for a scan without beams.
planar_lidar_t to_planar_lidar(const LidarScan& scan);
lidar_t to_mbot_lidar(const LidarScan& scan);

OdometrySample to_odometry(const pose2D_t& message);
pose2D_t to_pose_message(Timestamp time, const Se2& pose);
Se2 to_se2(const pose2D_t& message);

MarkerDetections to_detections(const marker_detections_t& message);
marker_detections_t to_detections_message(const MarkerDetections& detections);

}  // namespace waymark
