// SPDX-License-Identifier: BSD-3-Clause
// The map of one particle: where beams ended, with sub-cell resolution, and no free space.
#pragma once

#include "slam/core/grid/grid_frame.hpp"
#include "slam/core/grid/sparse_tile.hpp"
#include "slam/core/grid/tile_map.hpp"

#include <Eigen/Core>

#include <cstdint>

namespace waymark {

/// Mean of the points that were hit in a cell, in cells from the cell's centre. (A mean relative to
/// the centre, instead of a sum of map coordinates, is precise enough in floats for any run length
/// and distance.)
struct HitCell {
  float mean_x{0.0F};
  float mean_y{0.0F};
  std::uint32_t hits{0};

  void add(float x, float y) {
    ++hits;
    mean_x += (x - mean_x) / static_cast<float>(hits);
    mean_y += (y - mean_y) / static_cast<float>(hits);
  }

  bool operator==(const HitCell&) const = default;
};

using HitMap = TileMap<HitCell, SparseTile<HitCell>>;

inline void add_hit(const GridFrame& frame, const Eigen::Vector2d& point_in_map, HitMap& map) {
  const CellIndex cell = frame.cell_of(point_in_map);
  const Eigen::Vector2f in_cells =
      ((point_in_map - frame.centre_of(cell)) / frame.resolution_m).cast<float>();
  map.edit(cell).add(in_cells.x(), in_cells.y());
}

inline bool is_hit(const HitMap& map, CellIndex cell) {
  const HitMap::Tile* tile = map.tile(tile_of(cell));
  return tile && tile->is_touched(offset_in_tile(cell));
}

}  // namespace waymark
