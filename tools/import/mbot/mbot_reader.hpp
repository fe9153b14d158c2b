// SPDX-License-Identifier: BSD-3-Clause
// Reads an LCM log of an MBot robot, or of one with bot_core types.
#pragma once

#include "import/log/imported_log.hpp"
#include "import/mbot/wheel_odometry.hpp"

#include <filesystem>
#include <string>

namespace waymark {

struct MbotOptions {
  std::string lidar_channel{"RPLIDAR_LASER"};  ///< lidar_t or planar_lidar_t
  std::string odometry_channel{};   ///< pose2D_t, pose_xyt_t, odometry_t or bot_core.pose_t
  std::string encoder_channel{};    ///< MAEBot's encoders; given only without odometry_channel
  std::string camera_channel{};     ///< image_t; empty: CAMERA, if the log has such images
  std::string reference_channel{};  ///< poses to compare with, types as for odometry; empty: none
  std::optional<double> meters_per_tick{};  ///< nullopt = that of the robot model, geometry_of()
  std::optional<double> wheel_base_m{};     ///< nullopt = that of the robot model, geometry_of()
  std::optional<double> range_max_m{};      ///< nullopt = see mark_no_returns(); usual: RPLIDAR A1
  double range_min_m{0.0};
  LidarMounting mounting{};
};

/// lidar_t messages are kept unchanged, with the times of their beams. If no odometry channel is
/// given, the only channel with MAEBot ticks is used, with a note. Odometry, images and reference
/// with stamps of another clock than the LiDAR's are shifted to its clock, see put_on_clock().
/// @throws SetupError when the file is unreadable, empty, lacks a given channel, or has no scan or
/// no odometry.
ImportedLog read_mbot_log(const std::filesystem::path& file, const MbotOptions& options,
                          ImportReport& report);

}  // namespace waymark
