// SPDX-License-Identifier: BSD-3-Clause
// The map as a rectangle of cells, input of painters and map files.
#pragma once

#include <Eigen/Core>
#include <opencv2/core.hpp>

namespace waymark::viewer {

constexpr int kUnknownOccupancy = -1;

/// A cell is occupied from an occupancy of `occupied` on, and free up to `free`. Defaults: those of
/// ROS's map_saver.
struct MapThresholds {
  double occupied{0.65};
  double free{0.196};
};

enum class CellKind { kUnknown, kFree, kOccupied };

inline CellKind kind_of(int occupancy_percent, const MapThresholds& thresholds) {
  if (occupancy_percent < 0) return CellKind::kUnknown;
  const double occupancy = occupancy_percent / 100.0;
  if (occupancy >= thresholds.occupied) return CellKind::kOccupied;
  return occupancy <= thresholds.free ? CellKind::kFree : CellKind::kUnknown;
}

/// Occupancy and marker id per cell. Row 0 is the lowest y, column 0 the lowest x.
struct GridMap {
  cv::Mat_<schar> occupancy_percent{};                ///< 0..100, -1 = unknown
  cv::Mat_<short> marker_ids{};                       ///< same size; -1 = no marker
  Eigen::Vector2d origin_m{Eigen::Vector2d::Zero()};  ///< corner of cell (0, 0), map frame
  double resolution_m{0.05};

  bool empty() const { return occupancy_percent.empty(); }

  /// Centre of a cell, map frame.
  Eigen::Vector2d cell_centre_m(int row, int column) const {
    return origin_m + resolution_m * Eigen::Vector2d{column + 0.5, row + 0.5};
  }
};

/// A map of larger cells: each is `factor` x `factor` cells of the given one, with the highest
/// occupancy and id among them, so that no wall is lost.
GridMap shrunk(const GridMap& map, int factor);

}  // namespace waymark::viewer
