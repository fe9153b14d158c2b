// SPDX-License-Identifier: BSD-3-Clause
// A tile that stores only the cells that were touched: small to keep and quick to copy.
#pragma once

#include "slam/core/grid/tile_map.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace waymark {

/// Use as TileMap<Cell, SparseTile<Cell>> for layers in which few cells of a tile are ever written,
/// such as walls. A bit per cell marks the touched ones, which are stored packed, row by row.
/// Reading is O(1); touching a new cell moves those after it.
template <class Cell>
class SparseTile {
 public:
  const Cell& operator[](std::size_t offset) const {
    return is_touched(offset) ? cells_[place_of(offset)] : kUntouched;
  }

  /// The cell for writing; it counts as touched from now on.
  Cell& operator[](std::size_t offset) {
    const std::size_t place = place_of(offset);
    if (!is_touched(offset)) {
      cells_.insert(cells_.begin() + static_cast<std::ptrdiff_t>(place), Cell{});
      touched_[row_of(offset)] |= bit_of(offset);
      for (std::size_t row = row_of(offset) + 1; row < kTileSize; ++row)
        ++first_[row];
    }
    return cells_[place];
  }

  bool is_touched(std::size_t offset) const {
    return (touched_[row_of(offset)] & bit_of(offset)) != 0;
  }

  /// Calls visit(column, cell) for the touched cells of a row in columns [low, high] of the tile.
  template <class Visit>
  void visit_row(int row, int low, int high, Visit&& visit) const {
    const auto y = static_cast<std::size_t>(row);
    const std::uint32_t from_low = ~std::uint32_t{0} << low;
    const std::uint32_t to_high = ~std::uint32_t{0} >> (kTileSize - 1 - high);
    std::uint32_t left = touched_[y] & from_low & to_high;
    if (left == 0) return;
    std::size_t place = first_[y] + number_of_bits(touched_[y] & ~from_low);
    for (; left != 0; left &= left - 1) {
      visit(std::countr_zero(left), cells_[place++]);
    }
  }

 private:
  inline static const Cell kUntouched{};

  static std::size_t row_of(std::size_t offset) { return offset >> kTileBits; }

  static std::uint32_t bit_of(std::size_t offset) {
    return std::uint32_t{1} << (offset & (kTileSize - 1));
  }

  /// std::popcount is a function call on the oldest x86-64, which costs the matcher 2 %.
  static std::size_t number_of_bits(std::uint32_t bits) {
    bits -= (bits >> 1) & 0x55555555U;
    bits = (bits & 0x33333333U) + ((bits >> 2) & 0x33333333U);
    return (((bits + (bits >> 4)) & 0x0f0f0f0fU) * 0x01010101U) >> 24;
  }

  std::size_t place_of(std::size_t offset) const {
    const std::size_t row = row_of(offset);
    return first_[row] + number_of_bits(touched_[row] & (bit_of(offset) - 1));
  }

  std::array<std::uint32_t, kTileSize> touched_{};  ///< bit x of row y
  std::array<std::uint16_t, kTileSize> first_{};    ///< index in cells_ of each row's first cell
  std::vector<Cell> cells_{};
};

/// Calls visit(CellIndex, const Cell&) for the touched cells of the square of side 2 reach + 1
/// around `centre`, row by row within each tile.
template <class Cell, class Visit>
void visit_touched_around(const TileMap<Cell, SparseTile<Cell>>& map, CellIndex centre, int reach,
                          Visit&& visit) {
  const CellIndex low{centre.x - reach, centre.y - reach};
  const CellIndex high{centre.x + reach, centre.y + reach};
  const TileIndex first = tile_of(low);
  const TileIndex last = tile_of(high);
  for (int tile_y = first.y; tile_y <= last.y; ++tile_y) {
    for (int tile_x = first.x; tile_x <= last.x; ++tile_x) {
      const SparseTile<Cell>* tile = map.tile({tile_x, tile_y});
      if (!tile) continue;
      const CellIndex corner{tile_x * kTileSize, tile_y * kTileSize};
      const int column_low = std::max(low.x - corner.x, 0);
      const int column_high = std::min(high.x - corner.x, kTileSize - 1);
      const int row_high = std::min(high.y - corner.y, kTileSize - 1);
      for (int row = std::max(low.y - corner.y, 0); row <= row_high; ++row) {
        tile->visit_row(row, column_low, column_high, [&](int column, const Cell& cell) {
          visit(CellIndex{corner.x + column, corner.y + row}, cell);
        });
      }
    }
  }
}

}  // namespace waymark
