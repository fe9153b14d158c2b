// SPDX-License-Identifier: BSD-3-Clause
// An unbounded grid in copy-on-write tiles: copying a map copies no cells.
#pragma once

#include "slam/core/grid/cell_index.hpp"
#include "slam/core/grid/copy_on_write.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <utility>
#include <vector>

namespace waymark {

/// Cells at any (also negative) index; a cell that was never edited reads as Cell{}.
/// Reading costs two shifts and a table look-up; copying a map costs one counter increment per
/// tile; the first edit of a shared tile copies that tile only.
/// @tparam TileOfCells  how a tile stores its cells: anything indexed by offset_in_tile, e.g.
///                      SparseTile where most cells stay untouched.
template <class Cell, class TileOfCells = std::array<Cell, kTileCells>>
class TileMap {
 public:
  using Tile = TileOfCells;

  const Cell& operator[](CellIndex cell) const {
    const Tile* cells = tile(tile_of(cell));
    return cells ? (*cells)[offset_in_tile(cell)] : kUntouched;
  }

  /// The cell for writing; its tile becomes this map's own.
  /// @throws std::length_error when the map would span more than kMaxTableTiles tiles.
  Cell& edit(CellIndex cell) { return edit_tile(tile_of(cell))[offset_in_tile(cell)]; }

  /// A whole tile for writing, as edit(); the reference is valid until the map is copied.
  Tile& edit_tile(TileIndex index) {
    if (!covers(index)) grow_to(index);
    return table_[place_of(index)].edit();
  }

  /// Null where nothing was edited. Two maps share a tile when the addresses are equal.
  const Tile* tile(TileIndex index) const {
    return covers(index) ? table_[place_of(index)].get() : nullptr;
  }

  /// Calls visit(TileIndex, const Tile&) for every tile, row by row.
  template <class Visit>
  void for_each_tile(Visit&& visit) const {
    for (int row = 0; row < rows_; ++row) {
      for (int column = 0; column < columns_; ++column) {
        const TileIndex index{first_.x + column, first_.y + row};
        if (const Tile* cells = tile(index)) visit(index, *cells);
      }
    }
  }

  std::size_t num_tiles() const {
    return static_cast<std::size_t>(
        std::count_if(table_.begin(), table_.end(), [](const auto& tile) { return tile.get(); }));
  }

  /// [tile] Bound of the table's area: 3.2 km by 3.2 km of 0.05 m cells, 32 MB of pointers.
  static constexpr std::int64_t kMaxTableTiles = 1 << 22;

 private:
  inline static const Cell kUntouched{};

  bool covers(TileIndex index) const {
    return index.x >= first_.x && index.x < first_.x + columns_ && index.y >= first_.y &&
           index.y < first_.y + rows_;
  }

  std::size_t place_of(TileIndex index) const {
    return static_cast<std::size_t>(index.y - first_.y) * static_cast<std::size_t>(columns_) +
           static_cast<std::size_t>(index.x - first_.x);
  }

  /// One dimension of the table: extended to include `index`, and by a quarter more on that side,
  /// so that a robot that continues in this direction does not reallocate the table at every tile.
  struct Extent {
    int first;
    int count;
  };

  static Extent extended(Extent old, int index) {
    if (old.count == 0) return {index, 1};
    const int slack = old.count / 4;
    if (index < old.first) return {index - slack, old.first + old.count - (index - slack)};
    if (index >= old.first + old.count) return {old.first, index + slack - old.first + 1};
    return old;
  }

  void grow_to(TileIndex index) {
    TileMap grown;
    const Extent x = extended({first_.x, columns_}, index.x);
    const Extent y = extended({first_.y, rows_}, index.y);
    if (static_cast<std::int64_t>(x.count) * y.count > kMaxTableTiles) {
      throw std::length_error{"the map would span more tiles than a building has"};
    }
    grown.first_ = {x.first, y.first};
    grown.columns_ = x.count;
    grown.rows_ = y.count;
    grown.table_.resize(static_cast<std::size_t>(x.count) * static_cast<std::size_t>(y.count));
    for (int row = 0; row < rows_; ++row) {
      for (int column = 0; column < columns_; ++column) {
        const TileIndex moved{first_.x + column, first_.y + row};
        grown.table_[grown.place_of(moved)] = std::move(table_[place_of(moved)]);
      }
    }
    *this = std::move(grown);
  }

  TileIndex first_{};
  int columns_{0};
  int rows_{0};
  std::vector<CopyOnWrite<Tile>> table_{};
};

/// Edits cells that are near each other: looks their tile up only once. The map must not be copied
/// meanwhile.
template <class Map>
class TileEditor {
 public:
  explicit TileEditor(Map& map) : map_{map} {}

  auto& edit(CellIndex cell) {
    const TileIndex index = tile_of(cell);
    if (tile_ == nullptr || index != index_) {
      index_ = index;
      tile_ = &map_.edit_tile(index);
    }
    return (*tile_)[offset_in_tile(cell)];
  }

 private:
  Map& map_;
  TileIndex index_{};
  typename Map::Tile* tile_{nullptr};
};

}  // namespace waymark
