// SPDX-License-Identifier: BSD-3-Clause
#include "slam/map_publisher.hpp"

#include "common/messages/message.hpp"
#include "slam/in_parts.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

namespace waymark {
namespace {

constexpr std::size_t kTilesPerMessage = 20;  // 20 * (12 + 3 * 1024) bytes: fits one datagram

/// Tiles that exist in either layer, row by row.
std::vector<TileIndex> tiles_of(const GridMap& map) {
  std::vector<TileIndex> occupancy;
  std::vector<TileIndex> markers;
  map.occupancy.for_each_tile([&](TileIndex index, const auto&) { occupancy.push_back(index); });
  map.markers.for_each_tile([&](TileIndex index, const auto&) { markers.push_back(index); });
  std::vector<TileIndex> tiles;
  std::ranges::set_union(occupancy, markers, std::back_inserter(tiles));
  return tiles;
}

std::int8_t percent(const OccupancyCell& cell) {
  if (!cell.is_mapped()) return -1;
  if (cell.hits == 0) return 0;  // most cells; rounding takes long
  return static_cast<std::int8_t>(std::lround(100.0 * cell.occupancy()));
}

map_tile_t to_message(const GridMap& map, TileIndex index) {
  map_tile_t tile{};
  tile.tile_x = index.x;
  tile.tile_y = index.y;
  tile.num_cells = kTileCells;
  tile.occupancy.assign(kTileCells, percent({}));
  tile.marker_ids.assign(kTileCells, static_cast<std::int16_t>(MarkerCell{}.most_supported()));
  if (const auto* occupancy = map.occupancy.tile(index)) {
    for (std::size_t offset = 0; offset < kTileCells; ++offset)
      tile.occupancy[offset] = percent((*occupancy)[offset]);
  }
  if (const auto* markers = map.markers.tile(index)) {
    for (std::size_t offset = 0; offset < kTileCells; ++offset)
      tile.marker_ids[offset] = static_cast<std::int16_t>((*markers)[offset].most_supported());
  }
  return tile;
}

std::vector<map_tiles_t> to_messages(const GridMap& map, const std::vector<TileIndex>& tiles,
                                     Timestamp time) {
  return in_parts<map_tiles_t>(
      tiles.size(), kTilesPerMessage, time, [&](map_tiles_t& message, const Part& part) {
        message.origin_x_m = map.frame.origin_m.x();
        message.origin_y_m = map.frame.origin_m.y();
        message.resolution_m = map.frame.resolution_m;
        message.tile_size_cells = kTileSize;
        for (const TileIndex tile : part.of(tiles))
          message.tiles.push_back(to_message(map, tile));
        message.num_tiles = static_cast<std::int32_t>(message.tiles.size());
      });
}

/// Log odds of the cell's occupancy in the units of MBot grids, which are integers.
std::int8_t log_odds(const OccupancyCell& cell) {
  if (!cell.is_mapped()) return 0;
  constexpr double kPerUnit = 20.0;  // probability 0.5 -> 0, 0.998 -> 127
  const double probability = (cell.hits + 0.5) / (cell.visits + 1.0);
  const double odds = kPerUnit * std::log(probability / (1.0 - probability));
  return static_cast<std::int8_t>(std::clamp(std::lround(odds), -127L, 127L));
}

/// Bounding box of all mapped cells.
struct CellBox {
  int left{std::numeric_limits<int>::max()};
  int right{std::numeric_limits<int>::min()};
  int bottom{std::numeric_limits<int>::max()};
  int top{std::numeric_limits<int>::min()};

  int width() const { return right - left + 1; }

  int height() const { return top - bottom + 1; }
};

std::optional<CellBox> known_cells(const GridMap& map) {
  std::optional<CellBox> box;
  map.occupancy.for_each_tile([&box](TileIndex index, const auto& tile) {
    for (std::size_t offset = 0; offset < kTileCells; ++offset) {
      if (!tile[offset].is_mapped()) continue;
      const CellIndex cell = cell_at(index, offset);
      if (!box) box.emplace();
      box->left = std::min(box->left, cell.x);
      box->right = std::max(box->right, cell.x);
      box->bottom = std::min(box->bottom, cell.y);
      box->top = std::max(box->top, cell.y);
    }
  });
  return box;
}

/// Log odds of the most occupied cell of a square; 0 if none is mapped.
std::int8_t most_occupied(const GridMap& map, CellIndex first, int side) {
  std::optional<std::int8_t> most;
  for (int y = first.y; y < first.y + side; ++y) {
    for (int x = first.x; x < first.x + side; ++x) {
      const OccupancyCell& cell = map.occupancy[{x, y}];
      if (cell.is_mapped()) most = std::max(most.value_or(std::int8_t{-127}), log_odds(cell));
    }
  }
  return most.value_or(std::int8_t{0});
}

}  // namespace

bool MapPublisher::has_changed(const GridMap& map, TileIndex index) const {
  return map.occupancy.tile(index) != published_.occupancy.tile(index) ||
         map.markers.tile(index) != published_.markers.tile(index);
}

std::vector<map_tiles_t> MapPublisher::changed_tiles(const GridMap& map, Timestamp time) {
  const std::vector<TileIndex> all = tiles_of(map);
  std::vector<TileIndex> chosen;
  std::vector<TileIndex> others;
  for (const TileIndex index : all)
    (has_changed(map, index) ? chosen : others).push_back(index);
  for (std::size_t i = 0; i < std::min(kRefreshedTiles, others.size()); ++i)
    chosen.push_back(others[next_refreshed_++ % others.size()]);
  published_ = map;
  return to_messages(map, chosen, time);
}

std::vector<map_tiles_t> MapPublisher::all_tiles(const GridMap& map, Timestamp time) {
  std::vector<TileIndex> tiles;
  std::ranges::set_union(tiles_of(map), tiles_of(published_), std::back_inserter(tiles));
  published_ = map;
  return to_messages(map, tiles, time);
}

std::optional<occupancy_grid_t> to_occupancy_grid(const GridMap& map, Timestamp time) {
  const std::optional<CellBox> known = known_cells(map);
  if (!known) return std::nullopt;
  constexpr std::int64_t kHeaderBytes = 64;
  const auto cells_at = [&known](int merged) {
    return std::int64_t{(known->width() - 1) / merged + 1} * ((known->height() - 1) / merged + 1);
  };
  int merged = 1;  // map cells per side of a cell that is sent
  while (cells_at(merged) + kHeaderBytes > std::int64_t{kMaxPayloadBytes})
    ++merged;

  occupancy_grid_t grid{};
  grid.utime = to_us(time);
  const Eigen::Vector2d corner =
      map.frame.origin_m + map.frame.resolution_m * Eigen::Vector2d{known->left, known->bottom};
  grid.origin_x = static_cast<float>(corner.x());
  grid.origin_y = static_cast<float>(corner.y());
  grid.meters_per_cell = static_cast<float>(merged * map.frame.resolution_m);
  grid.width = (known->width() - 1) / merged + 1;
  grid.height = (known->height() - 1) / merged + 1;
  grid.num_cells = grid.width * grid.height;
  for (int y = 0; y < grid.height; ++y) {
    for (int x = 0; x < grid.width; ++x) {
      const CellIndex first{known->left + merged * x, known->bottom + merged * y};
      grid.cells.push_back(most_occupied(map, first, merged));
    }
  }
  return grid;
}

}  // namespace waymark
