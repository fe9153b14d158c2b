// SPDX-License-Identifier: BSD-3-Clause
// Time offsets of seconds between the stamps of two sensors, beyond what a driver's delay explains:
// found coarsely, so that they can be named instead of spoiling every other measurement.
#pragma once

#include "doctor/camera/camera_record.hpp"
#include "doctor/motion/lidar_motion.hpp"

#include <optional>
#include <vector>

namespace waymark {

/// Delay of the scans' stamps relative to odometry's, to a tenth of a second: the offset within
/// 10 s at which the turns of both fit, if they fit at no other one nearly as well.
/// @return nullopt if they fit within half a second (compare_turns() measures that), or nowhere.
std::optional<double> far_lidar_late_s(const std::vector<LidarTurn>& turns,
                                       const std::vector<ImportedPose>& odometry);

/// The same of the camera: the offset at which markers stand still while the robot moves by
/// odometry.
/// @param base_from_camera  as described.
std::optional<double> far_camera_late_s(const std::vector<CameraSighting>& sightings,
                                        const Eigen::Isometry3d& base_from_camera,
                                        const std::vector<ImportedPose>& odometry);

/// Correlation of consecutive turns, -1 to 1: robots turn for longer than from one scan to the
/// next; the noise of a robot that drives straight on is not positively correlated.
double persistence_of(const std::vector<LidarTurn>& turns);

}  // namespace waymark
