// SPDX-License-Identifier: BSD-3-Clause
// A path as points on the page.
#pragma once

#include "viewer/core/drawing/map_viewport.hpp"
#include "viewer/core/scene/scene.hpp"

#include <opencv2/core.hpp>

#include <span>
#include <vector>

namespace waymark::viewer {

inline const Se2& pose_of(const EstimatedPose& pose) {
  return pose.map_from_base;
}

inline const Se2& pose_of(const TimedPose& pose) {
  return pose.frame_from_base;
}

/// Positions on the page, thinned to steps of at least 3 px; poses that are not finite are left
/// out.
template <class Pose>
std::vector<cv::Point2d> points_on_page(const MapViewport& view, std::span<const Pose> path) {
  constexpr double kStep_px = 3.0;
  std::vector<cv::Point2d> points;
  for (const Pose& pose : path) {
    if (!pose_of(pose).translation().allFinite()) continue;
    const cv::Point2d point = view(pose_of(pose).translation());
    if (points.empty() || cv::norm(point - points.back()) >= kStep_px) points.push_back(point);
  }
  return points;
}

template <class Pose>
std::vector<cv::Point2d> points_on_page(const MapViewport& view, const std::vector<Pose>& path) {
  return points_on_page(view, std::span<const Pose>{path});
}

}  // namespace waymark::viewer
