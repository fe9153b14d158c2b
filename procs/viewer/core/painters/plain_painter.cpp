// SPDX-License-Identifier: BSD-3-Clause
#include "viewer/core/painters/plain_painter.hpp"

namespace waymark::viewer {

cv::Mat_<uchar> paint_plain(const GridMap& map, const MapThresholds& thresholds) {
  if (map.empty()) return cv::Mat_<uchar>(1, 1, kUnknownGrey);
  const int rows = map.occupancy_percent.rows;
  cv::Mat_<uchar> image(map.occupancy_percent.size(), kUnknownGrey);
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < image.cols; ++column) {
      const CellKind kind = kind_of(map.occupancy_percent(row, column), thresholds);
      if (kind == CellKind::kUnknown) continue;
      image(rows - 1 - row, column) = kind == CellKind::kFree ? kFreeGrey : kOccupiedGrey;
    }
  }
  return image;
}

}  // namespace waymark::viewer
