// SPDX-License-Identifier: BSD-3-Clause
// The map that estimators publish: an occupancy layer and the paper's marker layer on one grid.
#pragma once

#include "slam/core/grid/grid_frame.hpp"
#include "slam/core/grid/marker_cell.hpp"
#include "slam/core/grid/occupancy_cell.hpp"
#include "slam/core/grid/tile_map.hpp"

namespace waymark {

struct GridMap {
  GridFrame frame{};
  TileMap<OccupancyCell> occupancy{};
  TileMap<MarkerCell> markers{};
};

}  // namespace waymark
