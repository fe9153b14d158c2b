// SPDX-License-Identifier: BSD-3-Clause
// The slam process: commands, and the last pose.
#include "common/logging/logging.hpp"
#include "slam/estimator_factory.hpp"
#include "slam/last_pose.hpp"
#include "slam/map_file.hpp"
#include "slam/slam_node.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace waymark {
namespace {

MapFileInfo map_info(const SlamConfig& config, const std::string& frame) {
  MapFileInfo info;
  info.frame = frame;
  info.marker_dictionary = config.robot.markers.dictionary;
  info.marker_size_m = config.robot.markers.size_m;
  return info;
}

StartPose unknown_start() {
  StartPose start;
  start.kind = StartKind::kAnywhere;
  return start;
}

/// The start for another estimator that continues from an estimate.
StartPose start_at(const Estimate& estimate) {
  constexpr double kMinSigma_m = 0.02;  // the map is known to about a cell
  constexpr double kMinSigma_rad = 0.01;
  const Eigen::Vector3d sigmas = estimate.covariance.diagonal().cwiseMax(0.0).cwiseSqrt();
  return {StartKind::kPose,
          estimate.map_from_base.x(),
          estimate.map_from_base.y(),
          estimate.map_from_base.theta(),
          std::max(kMinSigma_m, sigmas.head<2>().maxCoeff()),
          std::max(kMinSigma_rad, sigmas.z())};
}

}  // namespace

std::int64_t SlamNode::save_map_to(const std::filesystem::path& file, const MapSnapshot& map) {
  const std::int64_t map_id = write_map_file(file, map, map_info(config_, frame_));
  logging::info("map {:016x} is in '{}': {} markers, {} keyframes",
                static_cast<std::uint64_t>(map_id), file.string(), map.landmarks.size(),
                map.graph.poses.size());
  return map_id;
}

/// @return what was done. @throws Refusal
std::string SlamNode::obey(const Command& command) {
  if (!config_.slam.commands) throw Refusal{"commands are off: set slam.commands = true"};
  switch (command.kind) {
    case Command::Kind::kSaveMap:
      return save_named(command.map_name);
    case Command::Kind::kReset:
      return reset();
    case Command::Kind::kSetPose:
      return set_pose(command.pose);
    case Command::Kind::kSetMode:
      return set_mode(command.mode);
  }
  throw Refusal{"the kind of command is unknown"};
}

std::string SlamNode::save_named(const std::string& name) {
  if (config_.slam.state_folder.empty())
    throw Refusal{"there is no folder to save to: set slam.state_folder"};
  if (config_.slam.mode == MapMode::kLocalise)
    throw Refusal{"mode localise leaves the map as it is, so there is nothing to save"};
  const auto map = estimator_->snapshot();
  if (!map) throw Refusal{fmt::format("there is no map to save: {}", why_no_map())};
  const auto file = std::filesystem::path{config_.slam.state_folder} / (name + ".map.lcm");
  try {
    const std::int64_t map_id = save_map_to(file, *map);
    map_file_ids_.named = map_id;
    return fmt::format("map {:016x} is in '{}'", static_cast<std::uint64_t>(map_id), file.string());
  } catch (const std::exception& error) {
    throw Refusal{error.what()};
  }
}

/// Starts another estimator.
/// @param map    the loaded map; null: a new map.
/// @param start  of the robot in `map`; not used for a new map.
void SlamNode::begin_estimator(MapMode mode, std::shared_ptr<const MapSnapshot> map,
                               const StartPose& start) {
  const bool keeps_frame = map != nullptr;
  config_.slam.mode = mode;
  config_.slam.start = start;
  loaded_map_ = std::move(map);
  estimator_ = make_estimator(config_, loaded_map_, survey_);
  newest_estimate_.reset();
  refuted_ = {};
  map_period_.reset();
  if (last_estimate_time_) {
    // Clears the old map's tiles at subscribers.
    publish(channels::kSlamMap, map_publisher_.all_tiles(estimator_->map(), *last_estimate_time_));
    publish_markers(*last_estimate_time_);
  }
  if (mode == MapMode::kLocalise) return;
  // A map with an id of its own begins, in the loaded map's frame or in a new one.
  map_id_ = 0;
  map_publisher_ = {};
  correction_.forget();
  if (keeps_frame) return;
  map_file_ids_ = {};
  known_pose_.reset();
  frame_ = survey_.empty() ? "map" : "survey";
}

/// Looks for the robot in the whole loaded map, after its scans have refuted the start pose.
void SlamNode::localise_anywhere() {
  LoadedMapFit refuted = refuted_;
  if (const auto statistics = estimator_->statistics()) refuted += statistics->loaded_map;
  counters_.add("start poses that the scans refuted");
  logging::warn("the scans contradict the loaded map at the start pose: localises anywhere in it");
  begin_estimator(config_.slam.mode, loaded_map_, unknown_start());
  refuted_ = refuted;
}

std::string SlamNode::reset() {
  const bool has_map = loaded_map_ != nullptr;
  begin_estimator(config_.slam.mode, loaded_map_, has_map ? unknown_start() : StartPose{});
  return has_map ? "localises anew in the loaded map" : "a new map is begun";
}

std::string SlamNode::set_pose(const StartPose& pose) {
  if (!estimator_->set_pose(pose)) {
    throw Refusal{
        fmt::format("there is no map yet, or not yet its frame, the pose is more than {} m "
                    "away, or the estimator does "
                    "not support it",
                    farthest_pose_m(config_.slam.grid.resolution_m))};
  }
  return fmt::format("the robot is at ({:.3f}, {:.3f}) m, {:.4f} rad", pose.x_m, pose.y_m,
                     pose.yaw_rad);
}

std::string SlamNode::set_mode(MapMode mode) {
  if (config_.slam.estimator != EstimatorName::kWaymark)
    throw Refusal{"only the estimator 'waymark' has modes"};
  if (mode == config_.slam.mode) throw Refusal{"slam is in that mode already"};
  if (mode == MapMode::kLocalise && !config_.save_map.empty())
    throw Refusal{
        "the map is to be saved at the end (--save-map), so the mode must not end as localise"};
  if (mode == MapMode::kMap) {
    begin_estimator(MapMode::kMap, nullptr, {});
    return "a new map is begun";
  }
  std::shared_ptr<const MapSnapshot> map = loaded_map_;
  if (config_.slam.mode != MapMode::kLocalise) {
    if (mode == MapMode::kExtend) throw Refusal{"mode map extends its map already"};
    const auto drawn = estimator_->snapshot();
    if (!drawn) throw Refusal{fmt::format("there is no map to localise in: {}", why_no_map())};
    MapFile file = map_of(to_map_messages(*drawn, map_info(config_, frame_)));
    file.map.map_id = map_id_;
    map = std::make_shared<const MapSnapshot>(std::move(file.map));
  }
  begin_estimator(mode, std::move(map),
                  newest_estimate_ ? start_at(*newest_estimate_) : unknown_start());
  if (mode == MapMode::kLocalise) return "the map stays as it is";
  return "the map is extended";
}

/// To be called at the first observation, since odometry decides whether the last pose is still
/// valid.
void SlamNode::resume_last_pose(const Observation& first) {
  was_resumed_ = true;
  if (config_.slam.start.kind != StartKind::kLast) return;
  Resumption resumption{std::nullopt, "there is none"};
  try {
    if (const auto last = read_last_pose(config_.slam.state_folder))
      resumption = resume(*last, map_file_ids_.loaded, first.time, first.odom_from_base);
  } catch (const std::exception& error) {
    logging::warn("{}", error.what());
    resumption.why_not = "it cannot be read";
  }
  if (resumption.start && estimator_->set_pose(*resumption.start)) {
    logging::info("resumes at ({:.2f}, {:.2f}) m", resumption.start->x_m, resumption.start->y_m);
    return;
  }
  logging::info("the last pose is not used: {}; localises anywhere in the map", resumption.why_not);
}

/// Writes the newest known pose, with the ids of the map files of now: that of the map saved last
/// too, even if the pose has been lost since.
void SlamNode::keep_last_pose() {
  const bool is_known = newest_estimate_ && newest_estimate_->time == newest_ &&
                        (newest_estimate_->health == Health::kTracking ||
                         newest_estimate_->health == Health::kDegenerate);
  if (is_known) {
    const Eigen::Vector3d sigmas =
        newest_estimate_->covariance.diagonal().cwiseMax(0.0).cwiseSqrt();
    known_pose_ = LastPose{newest_, {}, newest_estimate_->map_from_base, sigmas, odom_from_base_};
  }
  if (config_.slam.state_folder.empty() || !known_pose_) return;
  known_pose_->map_ids.clear();
  for (const std::int64_t map_id : {map_file_ids_.loaded, map_file_ids_.saved, map_file_ids_.named})
    if (map_id != 0) known_pose_->map_ids.push_back(map_id);
  if (known_pose_->map_ids.empty()) return;
  try {
    write_last_pose(config_.slam.state_folder, *known_pose_);
  } catch (const std::exception& error) {
    counters_.add("last pose not written", CountKind::kLoss);
  }
}

}  // namespace waymark
