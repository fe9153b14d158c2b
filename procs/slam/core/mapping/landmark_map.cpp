// SPDX-License-Identifier: BSD-3-Clause
#include "slam/core/mapping/landmark_map.hpp"

#include "common/geometry/se2.hpp"

#include <Eigen/LU>

#include <algorithm>
#include <tuple>

namespace waymark {
namespace {

/// Least standard deviation of a detection [m, rad]; also keeps zero covariances invertible.
constexpr double kSigmaFloor = 1e-3;

Eigen::Matrix3d in_map(const Eigen::Matrix3d& covariance_in_base, const Se2& map_from_base) {
  return in_axes(map_from_base.rotation(), covariance_in_base) +
         kSigmaFloor * kSigmaFloor * Eigen::Matrix3d::Identity();
}

}  // namespace

Landmark LandmarkMap::Entry::landmark() const {
  const Eigen::Matrix3d averaged = information.inverse();
  const Eigen::Vector3d deviation = averaged * weighted_deviation;
  Landmark landmark = first;
  landmark.map_from_marker = moved_by(first.map_from_marker, deviation);
  landmark.covariance = averaged + pose_covariance_sum / landmark.sightings;
  return landmark;
}

void LandmarkMap::add(const MarkerSighting& sighting, const Se2& map_from_base,
                      const Eigen::Matrix3d& pose_covariance) {
  const Se2 map_from_marker = map_from_base * sighting.base_from_marker;
  Entry* nearest = nullptr;
  double nearest_m = same_within_m_;
  int instances = 0;
  for (Entry& entry : entries_) {
    if (entry.first.id != sighting.id) continue;
    ++instances;
    const double distance_m =
        (entry.landmark().map_from_marker.translation() - map_from_marker.translation()).norm();
    if (distance_m >= nearest_m) continue;
    nearest_m = distance_m;
    nearest = &entry;
  }
  if (!nearest) {
    if (entries_.size() == kMaxLandmarks) return;
    nearest = &entries_.emplace_back();
    nearest->first.id = sighting.id;
    nearest->first.instance = instances;
    nearest->first.map_from_marker = map_from_marker;
    nearest->first.first_seen = sighting.time;
  }
  const Eigen::Vector3d deviation =
      pose_difference(map_from_marker, nearest->first.map_from_marker);
  const Eigen::Matrix3d information = in_map(sighting.covariance_in_base, map_from_base).inverse();
  nearest->information += information;
  nearest->weighted_deviation += information * deviation;
  nearest->pose_covariance_sum +=
      at_end_of_lever(pose_covariance, map_from_marker.translation() - map_from_base.translation());
  ++nearest->first.sightings;
  nearest->first.last_seen = sighting.time;
}

std::vector<Landmark> LandmarkMap::landmarks() const {
  std::vector<Landmark> landmarks;
  landmarks.reserve(entries_.size());
  for (const Entry& entry : entries_)
    landmarks.push_back(entry.landmark());
  std::sort(landmarks.begin(), landmarks.end(), [](const Landmark& a, const Landmark& b) {
    return std::tie(a.id, a.instance) < std::tie(b.id, b.instance);
  });
  return landmarks;
}

}  // namespace waymark
