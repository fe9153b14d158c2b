// SPDX-License-Identifier: BSD-3-Clause
// The cell below each pixel of a picture of the map. cv::warpAffine would do the same, but not for
// maps of 32767 cells or more along one side.
#pragma once

#include "viewer/core/drawing/map_viewport.hpp"
#include "viewer/core/scene/grid_map.hpp"

namespace waymark::viewer {

/// Calls paint(pixel, cell), both (column, row), for each pixel whose centre lies on the map.
template <class Paint>
void for_each_pixel_on_map(const MapViewport& view, const GridMap& map, cv::Size size_px,
                           const Paint& paint) {
  const Se2 map_from_view = view.view_from_map.inverse();
  const auto cells_at = [&](double x_px, double y_px) -> Eigen::Vector2d {
    const Eigen::Vector2d in_view{view.box.left_m + x_px / view.px_per_m,
                                  view.box.top_m - y_px / view.px_per_m};
    return (map_from_view * in_view - map.origin_m) / map.resolution_m;
  };
  const Eigen::Vector2d first = cells_at(0.5, 0.5);
  const Eigen::Vector2d along_row = cells_at(1.5, 0.5) - first;
  const Eigen::Vector2d along_column = cells_at(0.5, 1.5) - first;
  const Eigen::Array2d end{map.occupancy_percent.cols, map.occupancy_percent.rows};
  for (int y = 0; y < size_px.height; ++y) {
    for (int x = 0; x < size_px.width; ++x) {
      const Eigen::Array2d cell = first + x * along_row + y * along_column;
      if ((cell >= 0.0).all() && (cell < end).all())
        paint(cv::Point{x, y}, cv::Point{static_cast<int>(cell.x()), static_cast<int>(cell.y())});
    }
  }
}

}  // namespace waymark::viewer
