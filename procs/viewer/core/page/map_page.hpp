// SPDX-License-Identifier: BSD-3-Clause
// Where things go on map.png: a long map is folded into strips below an overview of the whole.
#pragma once

#include "viewer/core/drawing/view.hpp"
#include "viewer/core/page/style.hpp"
#include "viewer/core/scene/scene.hpp"

#include <optional>
#include <vector>

namespace waymark::viewer {

/// A window onto the map and its place on the page.
struct Panel {
  View view{};
  cv::Rect page_px{};
};

/// Whether a path that may drift far away from the map is drawn.
enum class Odometry { kIncluded, kLeftOut };

struct MapPage {
  cv::Size size_px{};
  cv::Rect heading_px{};
  std::optional<Panel> overview{};
  std::vector<Panel> strips{};
  Odometry odometry_in_strips{Odometry::kIncluded};  ///< left out where it would leave them
  cv::Rect legend_px{};  ///< as high as the longest legend; what it leaves free can be cut off
};

/// Height of the ruler below each strip.
constexpr int kRulerHeight_px = 58;

/// What the page is about: the map in cells, and the paths in the map.
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

/// The smallest upright box around the map and all paths after a rotation; markers and poses that
/// are absurdly far away from the map are left aside. Never empty.
Box bounds(const PageContent& content, const Se2& view_from_map, Odometry odometry);

/// Turns long maps so that they lie; leaves the others, and those that nearly lie, as they are.
Se2 view_from_map(const GridMap& map);

MapPage lay_out(const PageContent& content, const MapPageStyle& style);

}  // namespace waymark::viewer
