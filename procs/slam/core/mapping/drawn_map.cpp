// SPDX-License-Identifier: BSD-3-Clause
#include "slam/core/mapping/drawn_map.hpp"

#include "common/geometry/angle.hpp"
#include "slam/core/mapping/insert_scan.hpp"

#include <algorithm>
#include <cmath>

namespace waymark {
namespace {

// Scans that one redraw_some() redraws: 1 / kDrawnShare of all, within bounds.
constexpr std::size_t kMinDrawn = 8;
constexpr std::size_t kMaxDrawn = 64;
constexpr std::size_t kDrawnShare = 40;
constexpr std::size_t kCheckedPerDrawn = 32;  // checking so many costs as much as redrawing one
constexpr double kLever_m = 5.0;              // usual distance of walls from the robot

}  // namespace

DrawnMap::DrawnMap(const MapperConfig& config, const GridMap& base_map)
    : config_{config}, base_map_{base_map}, map_{base_map} {}

void DrawnMap::draw_markers(const std::vector<MarkerSighting>& sightings, const Se2& map_from_base,
                            GridMap& map) const {
  for (const MarkerSighting& sighting : sightings) {
    const auto points = face_points(sighting, config_.face_spacing_m, config_.face_margin_m);
    insert_face_points(points, config_.face_spacing_m, map_from_base, map);
  }
}

void DrawnMap::add(const Observation& observation, const Se2& map_from_base) {
  // The scan is drawn as the archive keeps it, in single precision, so that it can be erased
  // exactly; and archived last, since a scan outside the largest grid throws.
  if (const auto old = scans_.emptied_by(observation, map_from_base))
    erase_beams(scans_.at(*old).beams, drawn_at_[*old], map_);
  insert_beams(ScanArchive::as_kept(observation).beams, map_from_base, map_);
  draw_markers(observation.sightings, map_from_base, map_);
  scans_.add(observation, map_from_base);
  drawn_at_.push_back(map_from_base);
}

void DrawnMap::redraw_some(const std::function<Se2(std::size_t)>& pose_of) {
  if (unchecked_ == 0) return;
  const std::size_t budget =
      std::clamp(scans_.size() / kDrawnShare, kMinDrawn, kMaxDrawn) * kCheckedPerDrawn;
  for (std::size_t spent = 0; unchecked_ > 0 && spent < budget; ++spent) {
    --unchecked_;
    if (next_ == 0) next_ = scans_.size();
    const std::size_t scan = --next_;
    const Se2 pose = pose_of(scan);
    const Se2& old = drawn_at_[scan];
    const double moved_m = (pose.translation() - old.translation()).norm() +
                           kLever_m * std::abs(angle_difference(pose.theta(), old.theta()));
    if (moved_m < config_.resolution_m || scans_.is_empty(scan)) continue;
    const Observation observation = scans_.at(scan);
    erase_beams(observation.beams, old, map_);
    insert_beams(observation.beams, pose, map_);
    drawn_at_[scan] = pose;
    has_moved_ = true;
    spent += kCheckedPerDrawn - 1;
  }
  if (unchecked_ > 0 || !has_moved_) return;
  has_moved_ = false;
  map_.markers = base_map_.markers;
  for (std::size_t scan = 0; scan < scans_.size(); ++scan)
    draw_markers(scans_.sightings(scan), drawn_at_[scan], map_);
}

void DrawnMap::redraw_all(const std::function<Se2(std::size_t)>& pose_of) {
  map_ = drawn_along(pose_of);
  for (std::size_t scan = 0; scan < scans_.size(); ++scan)
    drawn_at_[scan] = pose_of(scan);
  unchecked_ = 0;
  has_moved_ = false;
}

GridMap DrawnMap::drawn_along(const std::function<Se2(std::size_t)>& pose_of) const {
  GridMap map = base_map_;
  for (std::size_t scan = 0; scan < scans_.size(); ++scan) {
    insert_beams(scans_.at(scan).beams, pose_of(scan), map);
    draw_markers(scans_.sightings(scan), pose_of(scan), map);
  }
  return map;
}

}  // namespace waymark
