// SPDX-License-Identifier: BSD-3-Clause
#include "faults/injector.hpp"

#include "common/messages/codec.hpp"
#include "common/messages/convert.hpp"
#include "common/random/random.hpp"

#include <algorithm>
#include <utility>

namespace waymark::faults {
namespace {

/// Separate streams of random numbers, so that one fault does not change another's draws.
enum Stream : std::uint64_t { kSightings = 0xfa01, kGhosts = 0xfa02 };

void flip(marker_detection_t& detection) {
  std::swap(detection.position_m, detection.other_position_m);
  std::swap(detection.orientation, detection.other_orientation);
  std::swap(detection.reprojection_error_px, detection.other_reprojection_error_px);
}

template <class T>
const T& pick(const std::vector<T>& from, double uniform) {
  const auto index = static_cast<std::size_t>(uniform * static_cast<double>(from.size()));
  return from[std::min(index, from.size() - 1)];
}

}  // namespace

void LogContent::add(const Message& message) {
  if (message.channel != channels::kMarkers.name) return;
  const auto decoded = decode<marker_detections_t>(message.payload);
  if (!decoded.message) return;
  for (const marker_detection_t& detection : decoded.message->detections) {
    sightings.push_back(detection);
    const auto place = std::lower_bound(ids.begin(), ids.end(), detection.id);
    if (place == ids.end() || *place != detection.id) ids.insert(place, detection.id);
  }
}

std::optional<Message> Injector::apply(const Message& message) {
  if (!start_) start_ = message.time;
  const bool is_markers = message.channel == channels::kMarkers.name;
  const bool is_camera = message.channel == channels::kCamera.name;
  const bool is_lidar = message.channel == channels::kLidar.name;
  if (is_markers) ++frame_;
  const bool is_camera_off =
      (is_markers || is_camera) && is_off(config_.camera_off_s, message.time);
  const bool is_lidar_off = is_lidar && is_off(config_.lidar_off_s, message.time);
  if (is_camera_off || is_lidar_off) {
    injected_.insert(is_camera_off ? "camera_off_s" : "lidar_off_s");
    ++counts_[message.channel + " lost"];
    return std::nullopt;
  }
  if (is_markers) return with_faulty_markers(message);
  if (message.channel == channels::kOdometry.name) return with_faulty_odometry(message);
  return message;
}

std::vector<std::string> Injector::never_injected() const {
  std::vector<std::string> keys = config_.configured();
  std::erase_if(keys, [&](const std::string& key) { return injected_.contains(key); });
  return keys;
}

bool Injector::is_off(const std::vector<double>& times_s, Timestamp time) const {
  const double t_s = to_seconds(time - *start_);
  for (std::size_t i = 0; i + 1 < times_s.size(); i += 2) {
    if (t_s >= times_s[i] && t_s < times_s[i + 1]) return true;
  }
  return false;
}

Message Injector::with_faulty_markers(const Message& message) {
  const auto decoded = decode<marker_detections_t>(message.payload);
  if (!decoded.message) return message;
  marker_detections_t corrupted = *decoded.message;
  std::vector<marker_detection_t> kept;
  const bool is_dark = is_off(config_.markers_off_s, message.time);
  for (std::size_t i = 0; i < corrupted.detections.size(); ++i) {
    marker_detection_t detection = corrupted.detections[i];
    if (is_dark) {
      injected_.insert("markers_off_s");
      ++counts_["sightings in the dark"];
    } else if (corrupt(detection, i)) {
      kept.push_back(detection);
    }
  }
  corrupted.detections = std::move(kept);
  if (!is_dark) add_ghost(corrupted);
  corrupted.num_detections = static_cast<std::int32_t>(corrupted.detections.size());
  return encode(channels::kMarkers, corrupted);
}

bool Injector::corrupt(marker_detection_t& detection, std::uint64_t index) {
  // Always the same draws in the same order, so that one fault does not change another's.
  Random random{seed_, kSightings, frame_, index};
  const bool is_dropped = random.uniform() < config_.dropped_share;
  const bool is_flipped = random.uniform() < config_.flipped_share;
  const bool is_wrong = random.uniform() < config_.wrong_id_share;
  const double which = random.uniform();
  ++counts_["sightings"];
  if (is_dropped) {
    injected_.insert("dropped_share");
    ++counts_["sightings dropped"];
    return false;
  }
  if (is_flipped) {
    flip(detection);
    injected_.insert("flipped_share");
    ++counts_["sightings flipped"];
  }
  if (is_wrong && content_.ids.size() > 1) {
    detection.id = another_id(detection.id, which);
    injected_.insert("wrong_id_share");
    ++counts_["wrong ids"];
  }
  const int new_id = config_.id_of(detection.id);
  if (new_id != detection.id) injected_.insert(config_.every_id >= 0 ? "every_id" : "renamed_ids");
  detection.id = new_id;
  return true;
}

int Injector::another_id(int id, double uniform) const {
  std::vector<int> others;
  for (const int other : content_.ids) {
    if (other != id) others.push_back(other);
  }
  return pick(others, uniform);
}

void Injector::add_ghost(marker_detections_t& message) {
  Random random{seed_, kGhosts, frame_};
  if (random.uniform() >= config_.ghost_share || content_.sightings.empty()) return;
  marker_detection_t ghost = pick(content_.sightings, random.uniform());
  ghost.id = config_.id_of(pick(content_.ids, random.uniform()));
  message.detections.push_back(ghost);
  injected_.insert("ghost_share");
  ++counts_["ghosts"];
}

Message Injector::with_faulty_odometry(const Message& message) {
  const auto decoded = decode<pose2D_t>(message.payload);
  if (!decoded.message) return message;
  const Se2 recorded = to_se2(*decoded.message);
  if (!last_odometry_) odom_from_base_ = recorded;
  const Se2 step = last_odometry_ ? last_odometry_->inverse() * recorded : Se2{};
  last_odometry_ = recorded;
  const double distance_m = step.translation().norm();
  if (distance_m > 0.0) injected_.insert({"odometry_distance_factor", "odometry_drift_rad_per_m"});
  if (step.theta() != 0.0) injected_.insert("odometry_turn_factor");
  odom_from_base_ = odom_from_base_ * Se2{config_.odometry_distance_factor * step.translation(),
                                          config_.odometry_turn_factor * step.theta() +
                                              config_.odometry_drift_rad_per_m * distance_m};
  return encode(channels::kOdometry,
                to_pose_message(timestamp_from_us(decoded.message->utime), odom_from_base_));
}

}  // namespace waymark::faults
