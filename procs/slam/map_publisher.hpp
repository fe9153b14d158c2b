// SPDX-License-Identifier: BSD-3-Clause
// The map as messages, each of which fits one datagram.
#pragma once

#include "common/messages/channels.hpp"
#include "common/time/time.hpp"
#include "slam/core/grid/grid_map.hpp"

#include <cstddef>
#include <optional>
#include <vector>

namespace waymark {

/// Publishes the tiles that have changed since the last time, found by comparing addresses with a
/// copy of the map, and a few of the others in turn, so that late subscribers get all tiles.
class MapPublisher {
 public:
  std::vector<map_tiles_t> changed_tiles(const GridMap& map, Timestamp time);

  /// The whole map, and empty tiles where only the previously published map had tiles.
  std::vector<map_tiles_t> all_tiles(const GridMap& map, Timestamp time);

 private:
  static constexpr std::size_t kRefreshedTiles = 4;  ///< unchanged tiles per update

  bool has_changed(const GridMap& map, TileIndex index) const;

  GridMap published_{};
  std::size_t next_refreshed_{0};
};

/// The whole map, cropped to the mapped cells; none for an empty one. A map that does not fit one
/// message gets larger cells, each with the highest occupancy of the map's cells in it.
std::optional<occupancy_grid_t> to_occupancy_grid(const GridMap& map, Timestamp time);

}  // namespace waymark
