// SPDX-License-Identifier: BSD-3-Clause
// Where the robot was when slam last knew it, kept in the state folder over a restart.
#pragma once

#include "common/geometry/se2.hpp"
#include "common/time/time.hpp"
#include "slam/core/graph/map_snapshot.hpp"

#include <Eigen/Core>

#include <cstdint>
#include <filesystem>
#include <optional>

namespace waymark {

struct LastPose {
  Timestamp time{};
  std::int64_t map_id{0};  ///< of the map file in whose frame it is
  Se2 map_from_base{};
  Eigen::Vector3d sigmas{Eigen::Vector3d::Zero()};  ///< x [m], y [m], heading [rad]
  Se2 odom_from_base{};                             ///< as it was sent
};

std::filesystem::path last_pose_file(const std::filesystem::path& state_folder);

/// Whole or not at all.
/// @throws std::system_error naming the file.
void write_last_pose(const std::filesystem::path& state_folder, const LastPose& pose);

/// @return nothing when there is none.
/// @throws ConfigError naming file and line.
std::optional<LastPose> read_last_pose(const std::filesystem::path& state_folder);

/// What a later moment makes of a last pose.
struct Resumption {
  std::optional<StartPose> start{};
  const char* why_not{""};  ///< without a start: what does not fit
};

/// The last pose, carried on by odometry, where map and odometry still fit: the same map, and an
/// odometry that has counted on, by no more than the robot can have driven since. After a long
/// pause it must stand where it stood.
Resumption resume(const LastPose& last, std::int64_t map_id, Timestamp now,
                  const Se2& odom_from_base);

}  // namespace waymark
