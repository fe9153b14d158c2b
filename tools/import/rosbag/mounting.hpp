// SPDX-License-Identifier: BSD-3-Clause
// What transforms and CameraInfo say about the robot's sensors.
#pragma once

#include "import/log/imported_log.hpp"
#include "import/rosbag/ros_scan.hpp"
#include "import/rosbag/static_frames.hpp"

#include <string>

namespace waymark {

/// Names of frames; the base's is what the others are looked for in.
struct SensorFrames {
  std::string base{};
  std::string lidar{};
  std::string camera{};
};

/// Position and yaw of the LiDAR; where nothing leads to it, the origin, which is noted. What the
/// user gives overrules the transforms.
ScanPlane describe_lidar(LidarConfig& lidar, const StaticFrames& transforms,
                         const SensorFrames& frames, const LidarMounting& given,
                         ImportReport& report);

/// Lens and mounting of the camera; what the bag does not say is a guess, which is noted.
/// @param image  one of the bag's, whose size the lens has to be of
void describe_camera(CameraConfig& camera, const StaticFrames& transforms,
                     const SensorFrames& frames, const std::optional<RosCameraInfo>& info,
                     const ImportedImage& image, ImportReport& report);

}  // namespace waymark
