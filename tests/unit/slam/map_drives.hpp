// SPDX-License-Identifier: BSD-3-Clause
// Drives through one corridor on several days, and a map of the first.
#pragma once

#include "slam/map_file.hpp"
#include "slam/slam_node.hpp"
#include "slam_run.hpp"
#include "support/synthetic_corridor.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

namespace waymark::test {

namespace fs = std::filesystem;

inline SyntheticCorridor corridor_of(std::uint64_t seed) {
  SyntheticCorridor corridor;
  corridor.length_m = 14.0;
  corridor.drive_m = 12.0;
  corridor.speed_m_s = 0.3;
  corridor.seed = seed;
  corridor.markers = opposite_markers(corridor, 3.5, 3.0);
  return corridor;
}

struct Drive {
  std::vector<slam_estimate_t> estimates{};
  std::vector<marker_landmark_t> markers{};  ///< at the end
  std::vector<map_change_t> changes{};       ///< at the end
  std::vector<Message> messages{};           ///< everything
  bool failed{false};
};

inline Drive drive_through(const SlamConfig& config, const std::vector<Message>& messages) {
  Inbox inbox;
  Outbox outbox;
  SlamNode node{config, inbox, outbox};
  for (const Message& message : messages)
    inbox.deliver(message);
  node.finish();
  Drive result;
  result.failed = node.failed();
  result.messages = outbox.take();
  for (const Message& message : result.messages) {
    if (message.channel == channels::kSlamEstimate.name)
      result.estimates.push_back(*decode<slam_estimate_t>(message.payload).message);
    if (message.channel == channels::kSlamMarkers.name)
      result.markers = decode<marker_map_t>(message.payload).message->landmarks;
    if (message.channel == channels::kSlamChanges.name)
      result.changes = decode<map_changes_t>(message.payload).message->changes;
  }
  return result;
}

inline SlamConfig config_for(MapMode mode, const fs::path& map,
                             StartKind start = StartKind::kAnywhere) {
  SlamConfig config;
  config.slam.mode = mode;
  if (mode != MapMode::kMap) {
    config.load_map = map;
    config.slam.start.kind = start;
  } else {
    config.save_map = map;
  }
  return config;
}

/// Says that the robot is at a pose, with the usual sigmas.
inline command_t pose_command(const Se2& map_from_base) {
  command_t command{};
  command.command_id = 2;
  command.kind = command_t::KIND_SET_POSE;
  command.pose[0] = map_from_base.x();
  command.pose[1] = map_from_base.y();
  command.pose[2] = map_from_base.theta();
  command.sigmas[0] = command.sigmas[1] = 0.1;
  return command;
}

/// The first true pose of a drive is the origin of its map.
inline Se2 map_from_world(const SensorLog& log) {
  return log.truth.front().world_from_base.inverse();
}

inline Se2 true_pose(const SensorLog& log, std::int64_t utime) {
  const auto at =
      std::lower_bound(log.truth.begin(), log.truth.end(), timestamp_from_us(utime),
                       [](const TruePose& pose, Timestamp time) { return pose.time < time; });
  return at == log.truth.end() ? log.truth.back().world_from_base : at->world_from_base;
}

/// Largest distance of the estimates with a pose from the truth, in the map's frame.
inline double worst_error_m(const Drive& run, const SensorLog& log, const Se2& map_from_world,
                            std::size_t skipped = 0) {
  double worst_m = 0.0;
  for (const slam_estimate_t& estimate : run.estimates) {
    if (estimate.has_pose == 0) continue;
    if (skipped > 0) {
      --skipped;
      continue;
    }
    const Eigen::Vector2d truth = (map_from_world * true_pose(log, estimate.utime)).translation();
    worst_m = std::max(worst_m, std::hypot(estimate.x_m - truth.x(), estimate.y_m - truth.y()));
  }
  return worst_m;
}

inline std::size_t with_pose(const Drive& run) {
  return static_cast<std::size_t>(
      std::count_if(run.estimates.begin(), run.estimates.end(),
                    [](const slam_estimate_t& estimate) { return estimate.has_pose != 0; }));
}

class SavedMap : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    drive_ = new SensorLog{drive(corridor_of(1))};
    file_ = new fs::path{fs::path{::testing::TempDir()} /
                         ("saved_" + std::to_string(::getpid()) + ".map.lcm")};
    ASSERT_FALSE(drive_through(config_for(MapMode::kMap, *file_), messages_of(*drive_)).failed);
  }

  static void TearDownTestSuite() {
    fs::remove(*file_);
    delete file_;
    delete drive_;
  }

  static fs::path other_file(const std::string& name) {
    return fs::path{::testing::TempDir()} / (name + std::to_string(::getpid()) + ".map.lcm");
  }

  inline static SensorLog* drive_{nullptr};
  inline static fs::path* file_{nullptr};
};

}  // namespace waymark::test
