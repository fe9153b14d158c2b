// SPDX-License-Identifier: BSD-3-Clause
#include "viewer/core/scene/grid_map.hpp"

#include <algorithm>

namespace waymark::viewer {

GridMap shrunk(const GridMap& map, int factor) {
  if (factor <= 1 || map.empty()) return map;
  const cv::Size size{(map.occupancy_percent.cols - 1) / factor + 1,
                      (map.occupancy_percent.rows - 1) / factor + 1};
  GridMap small{.occupancy_percent = cv::Mat_<schar>(size, schar{kUnknownOccupancy}),
                .marker_ids = cv::Mat_<short>(size, short{-1}),
                .origin_m = map.origin_m,
                .resolution_m = factor * map.resolution_m};
  const auto keep_largest = [factor](const auto& cells, auto& blocks) {
    for (int row = 0; row < cells.rows; ++row) {
      for (int column = 0; column < cells.cols; ++column) {
        auto& block = blocks(row / factor, column / factor);
        block = std::max(block, cells(row, column));
      }
    }
  };
  keep_largest(map.occupancy_percent, small.occupancy_percent);
  keep_largest(map.marker_ids, small.marker_ids);
  return small;
}

}  // namespace waymark::viewer
