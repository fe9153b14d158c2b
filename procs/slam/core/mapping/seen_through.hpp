// SPDX-License-Identifier: BSD-3-Clause
// Free space of a map.
#pragma once

#include "slam/core/grid/grid_map.hpp"

#include <Eigen/Core>

namespace waymark {

/// Whether beams have crossed the cell of a place, its neighbours and all other cells within
/// `within_m`, and hardly any ended there.
/// @param place  map frame.
inline bool is_seen_through(const GridMap& map, const Eigen::Vector2d& place,
                            double within_m = 0.0) {
  constexpr double kMaxOccupancy = 0.1;
  const CellIndex centre = map.frame.cell_of(place);
  const auto is_free = [&](int x, int y) {
    const OccupancyCell& cell = map.occupancy[{centre.x + x, centre.y + y}];
    return cell.is_mapped() && cell.occupancy() <= kMaxOccupancy;
  };
  if (!is_free(0, 0)) return false;  // most calls end here
  const int reach = 1 + static_cast<int>(within_m / map.frame.resolution_m);
  for (int x = -reach; x <= reach; ++x)
    for (int y = -reach; y <= reach; ++y)
      if (!is_free(x, y)) return false;
  return true;
}

}  // namespace waymark
