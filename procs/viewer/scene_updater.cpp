// SPDX-License-Identifier: BSD-3-Clause
#include "viewer/scene_updater.hpp"

#include "common/enums/enum_of.hpp"

#include <fmt/format.h>

namespace waymark::viewer {
namespace {

/// Largest number of parts of one marker map; a part has up to 500 markers.
constexpr std::int32_t kMaxMarkerParts = 256;

Eigen::Matrix3d to_matrix(const double (&row_major)[9]) {
  return Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>{row_major};
}

std::optional<WeakAxis> to_weak_axis(const slam_estimate_t& message) {
  const Eigen::Vector3d direction{message.weak_axis[0], message.weak_axis[1], message.weak_axis[2]};
  if (direction.isZero()) return std::nullopt;
  return WeakAxis{.direction = direction,
                  .information = message.weak_information,
                  .source = enum_of(message.weak_axis_source, WeakAxisSource::kNothing)};
}

TimedPose to_timed_pose(const pose2D_t& message) {
  return {timestamp_from_us(message.utime), {message.x, message.y, message.theta}};
}

Landmark to_landmark(const marker_landmark_t& message) {
  return {.id = message.id,
          .instance = message.instance,
          .map_from_marker = {message.x_m, message.y_m, message.yaw_rad},
          .covariance = to_matrix(message.covariance),
          .sightings = message.sightings,
          .last_seen = timestamp_from_us(message.last_seen_utime),
          .state = enum_of(message.state, LandmarkState::kMoved)};
}

std::string_view problem_of(TiledMap::Outcome outcome) {
  switch (outcome) {
    case TiledMap::Outcome::kOlderThanKnown:
      return "older than what is known";
    case TiledMap::Outcome::kMalformed:
      return "malformed";
    case TiledMap::Outcome::kTooFarAway:
      return "too far away";
    case TiledMap::Outcome::kStored:
      break;
  }
  return "";
}

/// Keeps the first pose, on which paths are aligned, and every second one after it.
template <class Pose>
void keep_every_second(std::vector<Pose>& path) {
  std::size_t kept = 0;
  for (std::size_t i = 0; i < path.size(); i += 2)
    path[kept++] = path[i];
  path.resize(kept);
}

/// Shifts the path before a time to which the clock was set back. If only the last pose is later,
/// its stamp was wrong, and it is removed.
template <class Pose>
void make_earlier_than(Timestamp time, std::vector<Pose>& path) {
  if (path.back().time < time) return;
  if (path.size() == 1 || path[path.size() - 2].time < time) {
    path.pop_back();
    return;
  }
  const Duration shift = path.back().time - time;
  for (Pose& pose : path)
    pose.time -= shift;
}

}  // namespace

template <class Pose>
void SceneUpdater::append_live(std::vector<Pose>& path, ClockStepDetector& clock, const Pose& pose,
                               std::string_view path_name) {
  const bool is_late = !path.empty() && pose.time < path.back().time;
  const bool is_ahead =
      !path.empty() && pose.time > path.back().time + ClockStepDetector::kLongestPause;
  if (!is_late && !is_ahead) {
    clock.note_consistent();
  } else if (clock.note_inconsistent(pose.time)) {
    counters_.add(fmt::format("{} clock was set", path_name), CountKind::kEvent);
    make_earlier_than(clock.first_inconsistent(), path);
  } else if (is_ahead) {
    counters_.add(fmt::format("{} left out: time jumps ahead", path_name), CountKind::kLoss);
    return;
  }
  append(path, pose, path_name);
}

template <class Pose>
void SceneUpdater::append(std::vector<Pose>& path, const Pose& pose, std::string_view path_name) {
  if (!path.empty() && pose.time <= path.back().time) {
    counters_.add(fmt::format("{} left out: not newer", path_name), CountKind::kLoss);
    return;
  }
  if (path.size() >= kMaxPathPoses) {
    keep_every_second(path);
    counters_.add(fmt::format("{} kept at half of the rate up to now", path_name),
                  CountKind::kEvent);
  }
  path.push_back(pose);
}

void SceneUpdater::begin_map() {
  Scene fresh;
  fresh.title = scene_.title;
  fresh.odometry = std::move(scene_.odometry);
  fresh.truth = std::move(scene_.truth);
  scene_ = std::move(fresh);
  marker_parts_.clear();
  marker_parts_utime_ = -1;
  trajectory_parts_.clear();
  num_trajectory_parts_ = 0;
}

void SceneUpdater::add(const map_tiles_t& message) {
  const TileLayout layout{message.origin_x_m, message.origin_y_m, message.resolution_m,
                          message.tile_size_cells};
  for (const map_tile_t& tile : message.tiles) {
    const auto outcome =
        scene_.map.put(layout, timestamp_from_us(message.utime),
                       {tile.tile_x, tile.tile_y, tile.occupancy, tile.marker_ids});
    if (outcome != TiledMap::Outcome::kStored)
      counters_.add(fmt::format("SLAM_MAP tiles left out: {}", problem_of(outcome)),
                    CountKind::kLoss);
  }
}

void SceneUpdater::add(const marker_map_t& message) {
  const bool is_part = message.part >= 0 && message.part < message.num_parts;
  const bool is_late =
      is_older(timestamp_from_us(message.utime), timestamp_from_us(marker_parts_utime_));
  if (!is_part || message.num_parts > kMaxMarkerParts || is_late) {
    counters_.add("SLAM_MARKERS left out: not a part of the newest map", CountKind::kLoss);
    return;
  }
  if (message.utime != marker_parts_utime_ || message.num_parts != num_marker_parts_) {
    marker_parts_.clear();
    marker_parts_utime_ = message.utime;
    num_marker_parts_ = message.num_parts;
  }
  std::vector<Landmark>& part = marker_parts_[message.part];
  part.clear();
  for (const marker_landmark_t& landmark : message.landmarks)
    part.push_back(to_landmark(landmark));
  if (static_cast<int>(marker_parts_.size()) < num_marker_parts_) return;
  scene_.landmarks.clear();
  for (const auto& [index, landmarks] : marker_parts_)
    scene_.landmarks.insert(scene_.landmarks.end(), landmarks.begin(), landmarks.end());
}

void SceneUpdater::add(const map_changes_t& message) {
  std::vector<MapChange>& changes = scene_.changes.emplace();
  for (const map_change_t& change : message.changes) {
    changes.push_back({.kind = static_cast<MapChange::Kind>(change.kind),
                       .id = change.id,
                       .instance = change.instance,
                       .place = {change.x_m, change.y_m, change.yaw_rad},
                       .was_at = {change.was_x_m, change.was_y_m},
                       .size_m = change.size_m,
                       .sigmas = change.sigmas,
                       .support = change.support});
  }
}

void SceneUpdater::add(const findings_t& message) {
  std::vector<Finding>& findings = scene_.findings.emplace();
  for (const finding_t& finding : message.findings) {
    const bool has_share = finding.share >= 0.0;
    findings.push_back({finding.name, finding.text, finding.value,
                        has_share ? std::optional{finding.share} : std::nullopt});
  }
}

void SceneUpdater::add(const slam_estimate_t& message) {
  append_live(scene_.estimates, estimate_clock_,
              EstimatedPose{.time = timestamp_from_us(message.utime),
                            .map_from_base = {message.x_m, message.y_m, message.theta_rad},
                            .covariance = to_matrix(message.covariance),
                            .health = enum_of(message.health, Health::kLost),
                            .weak_axis = to_weak_axis(message)},
              "SLAM_ESTIMATE");
}

void SceneUpdater::add(const annotated_scan_t& message) {
  AnnotatedScan scan{.time = timestamp_from_us(message.utime),
                     .map_from_lidar = {message.x_m, message.y_m, message.theta_rad},
                     .ranges_m = {message.ranges.begin(), message.ranges.end()},
                     .angles_rad = {message.angles.begin(), message.angles.end()},
                     .marker_ids = {message.marker_ids.begin(), message.marker_ids.end()}};
  // scan.png shows the last scan with a beam on a marker, if there is one.
  if (scene_.scan && scene_.scan->has_marker() && !scan.has_marker()) return;
  scene_.scan = std::move(scan);
}

void SceneUpdater::add(const particles_t& message) {
  scene_.particles.clear();
  for (const particle_t& particle : message.particles)
    scene_.particles.emplace_back(particle.pose.x, particle.pose.y, particle.pose.theta);
}

void SceneUpdater::add(const trajectory_t& message) {
  if (message.part == 0) {
    num_trajectory_parts_ = 0;
    trajectory_parts_.clear();
  }
  if (message.part != num_trajectory_parts_) {
    counters_.add("SLAM_TRAJECTORY left out: an earlier part is missing", CountKind::kLoss);
    return;
  }
  for (const pose2D_t& pose : message.poses)
    append(trajectory_parts_, to_timed_pose(pose), "SLAM_TRAJECTORY");
  if (++num_trajectory_parts_ == message.num_parts) scene_.final_trajectory = trajectory_parts_;
}

void SceneUpdater::add_odometry(const pose2D_t& message) {
  append_live(scene_.odometry, odometry_clock_, to_timed_pose(message), "ODOMETRY");
}

void SceneUpdater::add_truth(const pose2D_t& message) {
  append_live(scene_.truth, truth_clock_, to_timed_pose(message), "TRUE_POSE");
}

}  // namespace waymark::viewer
