// SPDX-License-Identifier: BSD-3-Clause
// Assembles the map from tiles that arrive in any order, and repeatedly.
#pragma once

#include "common/time/time.hpp"
#include "viewer/core/scene/grid_map.hpp"

#include <chrono>
#include <cstdint>
#include <map>
#include <set>
#include <span>
#include <utility>
#include <vector>

namespace waymark::viewer {

/// Where tiles lie: cell (i, j) of tile (a, b) has its lower left corner at
/// origin + resolution * (a * size + i, b * size + j).
struct TileLayout {
  double origin_x_m{0.0};
  double origin_y_m{0.0};
  double resolution_m{0.05};
  int size_cells{0};

  bool operator==(const TileLayout&) const = default;
};

/// One tile's new content; both spans have size_cells squared entries, row by row from below.
struct TileUpdate {
  int tile_x{0};
  int tile_y{0};
  std::span<const std::int8_t> occupancy_percent{};
  std::span<const std::int16_t> marker_ids{};
};

/// A message whose stamp is further behind earlier messages is not late: the clock was set.
inline constexpr Duration kLongestDelay = std::chrono::seconds{10};

/// True for a stamp before a known one, unless it is more than kLongestDelay before: then the clock
/// was set back, or the known stamp was wrong, and the later message counts as newer.
inline bool is_older(Timestamp time, Timestamp known) {
  return time < known && time >= known - kLongestDelay;
}

class TiledMap {
 public:
  enum class Outcome { kStored, kOlderThanKnown, kMalformed, kTooFarAway };

  /// @param max_cells  largest rectangle of cells that the map may span: bounds the memory that a
  ///                   stray tile can ask for. Tiles beyond are left out.
  explicit TiledMap(std::int64_t max_cells) : max_cells_{max_cells} {}

  /// Stores a tile unless a newer one is known (is_older()). Another layout belongs to another map,
  /// so that all old tiles are removed.
  Outcome put(const TileLayout& layout, Timestamp time, const TileUpdate& update);

  /// Number of tiles that are missing because they were too far away.
  std::size_t num_left_out() const { return left_out_.size(); }

  /// True when no tile has come.
  bool empty() const { return tiles_.empty(); }

  /// The smallest rectangle that holds all known cells; empty when there are none.
  GridMap grid() const;

 private:
  struct Tile {
    Timestamp time{};
    std::vector<std::int8_t> occupancy_percent{};
    std::vector<std::int16_t> marker_ids{};
  };

  /// Tiles first..last in both directions, both included.
  struct TileBox {
    std::int64_t first_x{0}, first_y{0}, last_x{-1}, last_y{-1};

    void include(std::int64_t x, std::int64_t y);
    double columns(int size_cells) const;
    double rows(int size_cells) const;
  };

  GridMap grid_of_all_tiles() const;

  std::int64_t max_cells_;
  TileLayout layout_{};
  TileBox box_{};
  std::map<std::pair<int, int>, Tile> tiles_;
  std::set<std::pair<int, int>> left_out_;
};

/// The smallest rectangle that holds all known cells.
GridMap crop_to_known(const GridMap& map);

}  // namespace waymark::viewer
