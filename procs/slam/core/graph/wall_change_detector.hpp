// SPDX-License-Identifier: BSD-3-Clause
// Walls that are there and not in the map, or in the map and not there any more.
#pragma once

#include "slam/core/graph/map_snapshot.hpp"
#include "slam/core/grid/grid_map.hpp"
#include "slam/core/mapping/map_change.hpp"
#include "slam/core/scan/observation.hpp"

#include <memory>
#include <vector>

namespace waymark {

/// Counts the beams of this run in a grid of its own, and compares it with the map's cell by cell.
/// A pose that is off by a cell makes no change: a cell has changed only where all of its
/// neighbours differ, too. Memory is bounded by the map's area and the LiDAR's reach.
class WallChangeDetector {
 public:
  explicit WallChangeDetector(std::shared_ptr<const MapSnapshot> map);

  void add(const Observation& observation, const Se2& map_from_base);

  /// Clusters of changed cells, row by row. O(cells seen).
  std::vector<MapChange> changes() const;

 private:
  void age();

  std::shared_ptr<const MapSnapshot> map_;
  GridMap seen_;
  int num_scans_{0};
};

}  // namespace waymark
