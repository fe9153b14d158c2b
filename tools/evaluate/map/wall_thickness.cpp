// SPDX-License-Identifier: BSD-3-Clause
#include "evaluate/map/wall_thickness.hpp"

#include <algorithm>
#include <cstddef>

namespace waymark::evaluate {
namespace {

constexpr int kGap_cells = 3;
constexpr double kThickestShare = 0.005;
constexpr int kThickest_cells = 20;  ///< a metre at 5 cm; thicker walls count as this thick

class Mask {
 public:
  Mask(int width, int height)
      : width_{width}, height_{height}, cells_(static_cast<std::size_t>(width) * height, 0) {}

  int width() const { return width_; }

  int height() const { return height_; }

  int& operator()(int x, int y) { return cells_[static_cast<std::size_t>(y) * width_ + x]; }

  int operator()(int x, int y) const { return cells_[static_cast<std::size_t>(y) * width_ + x]; }

 private:
  int width_;
  int height_;
  std::vector<int> cells_;
};

/// Fills short gaps in one line of cells.
/// @param cell  returns a reference to the i-th cell.
template <class CellAt>
void fill_gaps(int length, CellAt cell) {
  int last_wall = -1;
  for (int i = 0; i < length; ++i) {
    if (cell(i) != 1) continue;
    if (last_wall >= 0 && i - last_wall - 1 <= kGap_cells) {
      for (int gap = last_wall + 1; gap < i; ++gap)
        cell(gap) = 2;  // filled, but no wall when gaps are filled in the other direction
    }
    last_wall = i;
  }
}

Mask walls_of(const MapImage& map) {
  Mask walls{map.width_px, map.height_px};
  for (int y = 0; y < map.height_px; ++y) {
    for (int x = 0; x < map.width_px; ++x)
      walls(x, y) = map.at(x, y) == Cell::kOccupied ? 1 : 0;
  }
  for (int y = 0; y < map.height_px; ++y)
    fill_gaps(map.width_px, [&](int x) -> int& { return walls(x, y); });
  for (int x = 0; x < map.width_px; ++x)
    fill_gaps(map.height_px, [&](int y) -> int& { return walls(x, y); });
  return walls;
}

/// For each cell the side of the largest full square of which it is the upper right cell.
Mask square_sides(const Mask& walls) {
  Mask side{walls.width(), walls.height()};
  for (int y = 0; y < walls.height(); ++y) {
    for (int x = 0; x < walls.width(); ++x) {
      if (walls(x, y) == 0) continue;
      const bool at_edge = x == 0 || y == 0;
      side(x, y) = at_edge ? 1 : 1 + std::min({side(x - 1, y), side(x, y - 1), side(x - 1, y - 1)});
    }
  }
  return side;
}

}  // namespace

int wall_thickness_cells(const MapImage& map) {
  const Mask sides = square_sides(walls_of(map));
  std::vector<std::size_t> count_of_side(kThickest_cells + 1, 0);
  std::size_t count = 0;
  for (int y = 0; y < sides.height(); ++y) {
    for (int x = 0; x < sides.width(); ++x) {
      if (sides(x, y) == 0) continue;
      ++count_of_side[static_cast<std::size_t>(std::min(sides(x, y), kThickest_cells))];
      ++count;
    }
  }
  std::size_t thicker = 0;
  for (int side = kThickest_cells; side > 0; --side) {
    thicker += count_of_side[static_cast<std::size_t>(side)];
    if (static_cast<double>(thicker) > kThickestShare * static_cast<double>(count)) return side;
  }
  return 0;
}

}  // namespace waymark::evaluate
