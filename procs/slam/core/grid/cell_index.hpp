// SPDX-License-Identifier: BSD-3-Clause
// Indices in an unbounded grid: cells, and the square tiles that store them.
#pragma once

#include <compare>
#include <cstddef>

namespace waymark {

/// Column and row of a cell; may be negative.
struct CellIndex {
  int x{0};
  int y{0};

  auto operator<=>(const CellIndex&) const = default;
};

/// Column and row of a tile; compares row by row.
struct TileIndex {
  int x{0};
  int y{0};

  bool operator==(const TileIndex&) const = default;

  std::strong_ordering operator<=>(const TileIndex& other) const {
    return y != other.y ? y <=> other.y : x <=> other.x;
  }
};

inline constexpr int kTileBits = 5;
inline constexpr int kTileSize = 1 << kTileBits;  ///< [cell] side of a tile
inline constexpr int kTileCells = kTileSize * kTileSize;

/// The tile that holds a cell. Shifts of negative numbers round down since C++20.
constexpr TileIndex tile_of(CellIndex cell) {
  return {cell.x >> kTileBits, cell.y >> kTileBits};
}

/// Index of a cell in its tile: row by row from the lower left.
constexpr std::size_t offset_in_tile(CellIndex cell) {
  return static_cast<std::size_t>((cell.y & (kTileSize - 1)) * kTileSize +
                                  (cell.x & (kTileSize - 1)));
}

/// The inverse of tile_of and offset_in_tile.
constexpr CellIndex cell_at(TileIndex tile, std::size_t offset) {
  const int place = static_cast<int>(offset);
  return {tile.x * kTileSize + (place & (kTileSize - 1)),
          tile.y * kTileSize + (place >> kTileBits)};
}

}  // namespace waymark
