// SPDX-License-Identifier: BSD-3-Clause
// Position of a grid's cells in the map frame.
#pragma once

#include "slam/core/grid/cell_index.hpp"

#include <Eigen/Core>

#include <cmath>

namespace waymark {

/// Cells are squares along the map's axes.
struct GridFrame {
  double resolution_m{0.05};
  Eigen::Vector2d origin_m{-0.025, -0.025};  ///< lower left corner of cell (0, 0) in the map

  /// The map's origin is the centre of cell (0, 0): then walls at multiples of the resolution from
  /// the start pose lie in the middle of cells, not on borders where noise would double them.
  static GridFrame centred_on_map_origin(double resolution_m) {
    return {resolution_m, Eigen::Vector2d::Constant(-0.5 * resolution_m)};
  }

  /// @param point_in_map  finite, within +-1e8 cells.
  CellIndex cell_of(const Eigen::Vector2d& point_in_map) const {
    const Eigen::Vector2d cells = (point_in_map - origin_m) / resolution_m;
    return {static_cast<int>(std::floor(cells.x())), static_cast<int>(std::floor(cells.y()))};
  }

  Eigen::Vector2d centre_of(CellIndex cell) const {
    return origin_m + resolution_m * Eigen::Vector2d{cell.x + 0.5, cell.y + 0.5};
  }
};

}  // namespace waymark
