// SPDX-License-Identifier: BSD-3-Clause
#include "slam/core/registration/submap.hpp"

#include <algorithm>
#include <cmath>

namespace waymark {
namespace {

// A smaller displacement is within the thickness of the walls in a submap.
constexpr double kDeformed_m = 0.03;
constexpr double kDeformed_rad = 0.006;  // displaces walls 5 m away by as much

}  // namespace

void Submap::insert(const Points& points_in_base, const Se2& submap_from_base) {
  if (!poses_.empty())
    path_length_m_ += (submap_from_base.translation() - poses_.back().translation()).norm();
  poses_.push_back(submap_from_base);
  radius_m_ = std::max(radius_m_, submap_from_base.translation().norm());
  add(points_in_base, submap_from_base);
}

void Submap::add(const Points& points_in_base, const Se2& submap_from_base) {
  scans_.push_back({points_in_base, last_keyframe(), poses_.back().inverse() * submap_from_base});
  draw(points_in_base, submap_from_base);
}

void Submap::draw(const Points& points_in_base, const Se2& submap_from_base) {
  const auto keyframe = static_cast<int>(last_keyframe());
  for (const Eigen::Vector2d& point : points_in_base) {
    const Eigen::Vector2d there = submap_from_base * point;
    ndt_.add(there, keyframe);
    const auto column = static_cast<int>(std::lround(there.x() / kThinned_m));
    const auto row = static_cast<int>(std::lround(there.y() / kThinned_m));
    if (!occupied_.insert(NdtMap::key(column, row)).second) continue;
    points_.push_back(there);
    coarse_.add(there);
  }
}

bool Submap::is_deformed(const PoseSequence& keyframes) const {
  if (is_shape_frozen_) return false;
  const Se2 here_from_map = submap_from_map(keyframes);
  for (std::size_t k = first_keyframe_; k <= last_keyframe(); ++k) {
    const Eigen::Vector3d moved =
        pose_difference(here_from_map * keyframes[k], submap_from_keyframe(k));
    if (moved.head<2>().norm() > kDeformed_m || std::abs(moved.z()) > kDeformed_rad) return true;
  }
  return false;
}

Submap Submap::rebuilt(const PoseSequence& keyframes) const {
  const Se2 here_from_map = submap_from_map(keyframes);
  Submap submap{spacing_m_, first_keyframe_};
  for (const Scan& scan : scans_) {
    const Se2 submap_from_keyframe = here_from_map * keyframes[scan.keyframe];
    if (scan.keyframe == first_keyframe_ + submap.num_keyframes())
      submap.insert(scan.points_in_base, submap_from_keyframe);
    else
      submap.add(scan.points_in_base, submap_from_keyframe * scan.keyframe_from_base);
  }
  return submap;
}

void Submap::finish(double point_variance_m2) {
  ndt_.drop_unused_parts(point_variance_m2);
  occupied_ = std::unordered_set<NdtMap::Key>{};  // unlike clear(), frees the buckets
  scans_ = std::vector<Scan>{};
}

}  // namespace waymark
