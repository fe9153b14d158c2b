// SPDX-License-Identifier: BSD-3-Clause
// An LCM log of an MBot robot, or of one with bot_core's types -> scans, odometry and reference.
#pragma once

#include "import/log/imported_log.hpp"
#include "import/mbot/wheel_odometry.hpp"

#include <filesystem>
#include <string>

namespace waymark {

struct MbotOptions {
  std::string lidar_channel{"RPLIDAR_LASER"};  ///< lidar_t or planar_lidar_t
  std::string odometry_channel{};           ///< pose2D_t, pose_xyt_t, odometry_t or bot_core.pose_t
  std::string encoder_channel{};            ///< MAEBot's encoders; at most one of the two is given
  std::string reference_channel{};          ///< types as for odometry; empty = none
  std::optional<double> meters_per_tick{};  ///< nullopt = of the robot that has such messages
  std::optional<double> wheel_base_m{};     ///< the same
  std::optional<double> range_max_m{};      ///< nullopt = see mark_no_returns(); usual: RPLIDAR A1
  double range_min_m{0.0};
  LidarMounting mounting{};
};

/// lidar_t messages are kept as they are (their beams' times undo the motion within a scan).
/// Without a channel for odometry, the only one with a MAEBot's ticks is taken. Odometry and
/// reference whose stamps are of another clock than the LiDAR's are put on its clock by the
/// logger's times. What was taken is said.
/// @throws SetupError when the file is unreadable, empty, lacks a channel, or gives no scan or no
/// odometry.
ImportedLog read_mbot_log(const std::filesystem::path& file, const MbotOptions& options,
                          ImportReport& report);

}  // namespace waymark
