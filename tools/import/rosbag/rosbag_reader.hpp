// SPDX-License-Identifier: BSD-3-Clause
// Reads scans, odometry, camera images and sensor mounting from a ROS bag.
#pragma once

#include "import/log/imported_log.hpp"

#include <filesystem>
#include <string>

namespace waymark {

struct RosbagOptions {
  std::string scan_topic{};      ///< empty = the only one with sensor_msgs/LaserScan
  std::string odometry_topic{};  ///< empty = the only one with nav_msgs/Odometry
  std::string image_topic{};  ///< CompressedImage or Image; empty = the only one, if there is one
  std::string camera_info_topic{};  ///< empty = the only one
  std::string base_frame{};         ///< empty = odometry's child frame
  bool without_images{false};
  std::optional<double> range_max_m{};  ///< nullopt = see mark_no_returns(), scans' range_max
  LidarMounting mounting{};
};

/// A scan with a time increment keeps the time of each beam (lidar_t). Mountings come from static
/// transforms, intrinsics from CameraInfo.
/// @throws SetupError if the file is no bag, has no scan or no odometry, or several topics match.
ImportedLog read_rosbag(const std::filesystem::path& file, const RosbagOptions& options,
                        ImportReport& report);

}  // namespace waymark
