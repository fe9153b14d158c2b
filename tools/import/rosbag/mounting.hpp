// SPDX-License-Identifier: BSD-3-Clause
// Mounting of the sensors and lens of the camera, from transforms and CameraInfo.
#pragma once

#include "import/log/imported_log.hpp"
#include "import/rosbag/ros_scan.hpp"
#include "import/rosbag/static_frames.hpp"

#include <string>

namespace waymark {

/// Names of frames; LiDAR and camera are looked up relative to `base`.
struct SensorFrames {
  std::string base{};
  std::string lidar{};
  std::string camera{};
};

/// Sets position and yaw of the LiDAR; the origin, with a note, if no fixed transforms lead to its
/// frame. Values given by the user override the transforms.
/// @return whether the LiDAR is mounted upside down.
LidarOrientation describe_lidar(LidarConfig& lidar, const StaticFrames& transforms,
                                const SensorFrames& frames, const LidarMounting& given,
                                ImportReport& report);

/// Whether the camera's images have been rectified by CameraInfo.
enum class ImageRectification { kRaw, kRectified };

/// Sets lens and mounting of the camera; values that the bag lacks are guessed, with a note.
/// @param image  an image of the bag, for its size in pixels
void describe_camera(CameraConfig& camera, const StaticFrames& transforms,
                     const SensorFrames& frames, const std::optional<RosCameraInfo>& info,
                     const ImportedImage& image, ImageRectification rectification,
                     ImportReport& report);

}  // namespace waymark
