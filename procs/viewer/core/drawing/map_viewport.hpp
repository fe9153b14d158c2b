// SPDX-License-Identifier: BSD-3-Clause
// Transforms metres in the map to pixels on a page.
#pragma once

#include "common/geometry/se2.hpp"

#include <opencv2/core.hpp>

#include <algorithm>
#include <cmath>

namespace waymark::viewer {

/// An upright rectangle in metres.
struct Box {
  double left_m{0.0}, bottom_m{0.0}, right_m{0.0}, top_m{0.0};

  double width_m() const { return right_m - left_m; }

  double height_m() const { return top_m - bottom_m; }
};

/// The part of the map that is drawn: `box` in the view frame (x right, y up), scaled by px_per_m,
/// its upper left corner at pixel (0, 0). operator() gives the pixel of a point in the map.
struct MapViewport {
  Se2 view_from_map{};
  Box box{};
  double px_per_m{1.0};

  cv::Point2d operator()(const Eigen::Vector2d& point_in_map) const {
    const Eigen::Vector2d point = view_from_map * point_in_map;
    return {px_per_m * (point.x() - box.left_m), px_per_m * (box.top_m - point.y())};
  }

  /// Unit vector on the page for a direction in the map.
  cv::Point2d direction(double angle_in_map_rad) const {
    const double angle = angle_in_map_rad + view_from_map.theta();
    return {std::cos(angle), -std::sin(angle)};
  }

  cv::Size size_px() const {
    return {std::max(1, static_cast<int>(std::lround(px_per_m * box.width_m()))),
            std::max(1, static_cast<int>(std::lround(px_per_m * box.height_m())))};
  }
};

/// Factor on the size of marks and strokes: 1 from 80 px/m on, smaller below.
inline double mark_scale(double px_per_m) {
  constexpr double kFullFrom_px_per_m = 80.0;
  constexpr double kSmallest = 0.3;
  return std::clamp(px_per_m / kFullFrom_px_per_m, kSmallest, 1.0);
}

}  // namespace waymark::viewer
