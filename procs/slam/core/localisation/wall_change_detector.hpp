// SPDX-License-Identifier: BSD-3-Clause
// Detects walls that have appeared or disappeared since a map was made.
#pragma once

#include "slam/core/grid/grid_map.hpp"
#include "slam/core/localisation/map_snapshot.hpp"
#include "slam/core/mapping/map_change.hpp"
#include "slam/core/scan/observation.hpp"

#include <memory>
#include <vector>

namespace waymark {

/// Counts this run's beams in a grid of its own, and compares that grid with the map's, cell by
/// cell. A wall cell has appeared if the map is free in it and all its neighbours; a wall cell of
/// the map has disappeared if this run's grid is free in it and all its neighbours. So a pose error
/// of one cell makes no change. Memory is bounded by the map's area and the LiDAR's range.
class WallChangeDetector {
 public:
  explicit WallChangeDetector(std::shared_ptr<const MapSnapshot> map);

  void add(const Observation& observation, const Se2& map_from_base);

  /// Clusters of changed cells: new walls, then walls that are gone, each row by row.
  /// O(cells observed).
  std::vector<MapChange> changes() const;

 private:
  void age();

  std::shared_ptr<const MapSnapshot> map_;
  GridMap seen_;
  int num_scans_{0};
};

}  // namespace waymark
