// SPDX-License-Identifier: BSD-3-Clause
// An occupancy map as cells that are free, occupied or unknown.
#pragma once

#include <cstdint>
#include <vector>

namespace waymark::corridor {

enum class Cell : std::uint8_t { kUnknown, kFree, kOccupied };

/// Cell (0, 0) is the lower left one; x runs right, y runs up, as in the map frame.
struct MapImage {
  int width_px{};
  int height_px{};
  double resolution_m{};
  std::vector<Cell> cells{};  ///< row by row, from the bottom

  bool contains(int x, int y) const { return x >= 0 && y >= 0 && x < width_px && y < height_px; }

  Cell at(int x, int y) const {
    return contains(x, y) ? cells[static_cast<std::size_t>(y) * width_px + x] : Cell::kUnknown;
  }
};

}  // namespace waymark::corridor
