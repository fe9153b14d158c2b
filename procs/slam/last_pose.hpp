// SPDX-License-Identifier: BSD-3-Clause
// The robot's last known pose, kept in the state folder across restarts.
#pragma once

#include "common/geometry/se2.hpp"
#include "common/time/time.hpp"
#include "slam/core/estimators/map_use.hpp"

#include <Eigen/Core>

#include <cstdint>
#include <filesystem>
#include <optional>
#include <vector>

namespace waymark {

struct LastPose {
  Timestamp time{};
  std::vector<std::int64_t> map_ids{};  ///< ids of the map files in whose frame the pose is
  Se2 map_from_base{};
  Eigen::Vector3d sigmas{Eigen::Vector3d::Zero()};  ///< x [m], y [m], heading [rad]
  Se2 odom_from_base{};                             ///< odometry as it was sent
};

bool is_in_map(const LastPose& pose, std::int64_t map_id);

std::filesystem::path last_pose_file(const std::filesystem::path& state_folder);

/// Atomic: a reader finds the old file or the new one.
/// @throws std::system_error naming the file.
void write_last_pose(const std::filesystem::path& state_folder, const LastPose& pose);

/// @return none if there is no file.
/// @throws ConfigError naming file and line.
std::optional<LastPose> read_last_pose(const std::filesystem::path& state_folder);

/// A start from the last pose, or the reason for none.
struct Resumption {
  std::optional<StartPose> start{};
  const char* why_not{""};  ///< without a start: what does not match
};

/// The last pose, propagated by odometry, if map and odometry still match: the map is the same, and
/// odometry has continued, by no more than the robot can have driven since. After a long pause
/// odometry must not have changed.
Resumption resume(const LastPose& last, std::int64_t map_id, Timestamp now,
                  const Se2& odom_from_base);

}  // namespace waymark
