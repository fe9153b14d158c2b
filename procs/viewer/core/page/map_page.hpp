// SPDX-License-Identifier: BSD-3-Clause
// Layout of map.png: a long map is folded into strips below an overview of the whole.
#pragma once

#include "viewer/core/drawing/map_viewport.hpp"
#include "viewer/core/page/style.hpp"
#include "viewer/core/scene/scene.hpp"

#include <optional>
#include <vector>

namespace waymark::viewer {

/// A part of the map and its place on the page.
struct Panel {
  MapViewport view{};
  cv::Rect page_px{};
};

/// Whether odometry's path, which may drift far away from the map, is drawn.
enum class OdometryPath { kIncluded, kLeftOut };

struct MapPage {
  cv::Size size_px{};
  cv::Rect heading_px{};
  std::optional<Panel> overview{};
  std::vector<Panel> strips{};
  /// Left out where it would shrink the map.
  OdometryPath odometry_in_strips{OdometryPath::kIncluded};
  cv::Rect legend_px{};  ///< as high as the longest possible legend; the unused part is cut off
};

/// Height of the ruler below each strip.
constexpr int kRulerHeight_px = 58;

/// Content of the page: the map as cells, paths and markers in the map frame.
struct PageContent {
  GridMap map{};
  std::vector<Landmark> landmarks{};
  std::vector<MapChange> changes{};
  std::vector<EstimatedPose> estimates{};
  std::vector<TimedPose> final_in_map{};
  std::vector<TimedPose> truth_in_map{};
  std::vector<TimedPose> odometry_in_map{};
  std::vector<Se2> particles{};
};

PageContent content_of(const Scene& scene);

/// Bounding box of the map, the markers and all paths in the view frame; markers and poses far away
/// from the map are ignored. Never empty.
Box bounds(const PageContent& content, const Se2& view_from_map, OdometryPath odometry);

/// Rotation that makes a long map horizontal; identity for other maps, and for long maps that are
/// within 20 degrees of horizontal.
Se2 view_from_map(const GridMap& map);

MapPage lay_out(const PageContent& content, const MapPageStyle& style);

}  // namespace waymark::viewer
