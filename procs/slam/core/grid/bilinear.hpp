// SPDX-License-Identifier: BSD-3-Clause
// Bilinear interpolation between cell centres.
#pragma once

#include "slam/core/grid/grid_frame.hpp"

namespace waymark {

/// Calls visit(CellIndex, weight) for the four cells around a point; the weights are bilinear and
/// sum to 1. Cells of 0.05 m then resolve displacements of millimetres.
template <class Visit>
void visit_bilinear(const GridFrame& frame, const Eigen::Vector2d& point_in_map, Visit&& visit) {
  const Eigen::Vector2d cells =
      (point_in_map - frame.origin_m) / frame.resolution_m - Eigen::Vector2d::Constant(0.5);
  const double left = std::floor(cells.x());
  const double low = std::floor(cells.y());
  const double x = cells.x() - left;
  const double y = cells.y() - low;
  const CellIndex cell{static_cast<int>(left), static_cast<int>(low)};
  visit(cell, (1.0 - x) * (1.0 - y));
  visit(CellIndex{cell.x + 1, cell.y}, x * (1.0 - y));
  visit(CellIndex{cell.x, cell.y + 1}, (1.0 - x) * y);
  visit(CellIndex{cell.x + 1, cell.y + 1}, x * y);
}

}  // namespace waymark
