// SPDX-License-Identifier: BSD-3-Clause
// The walls of a map, as points.
#pragma once

#include "slam/core/grid/grid_map.hpp"

#include <Eigen/Core>

#include <vector>

namespace waymark {

/// Centres of the cells where more than half of the beams ended, map frame; row by row of tiles.
inline std::vector<Eigen::Vector2d> occupied_points(const GridMap& map) {
  constexpr double kOccupied = 0.5;
  std::vector<Eigen::Vector2d> points;
  map.occupancy.for_each_tile([&](TileIndex index, const auto& cells) {
    for (std::size_t offset = 0; offset < kTileCells; ++offset)
      if (cells[offset].occupancy() > kOccupied)
        points.push_back(map.frame.centre_of(cell_at(index, offset)));
  });
  return points;
}

}  // namespace waymark
