// SPDX-License-Identifier: BSD-3-Clause
#include "common/corridor/medial_line.hpp"

#include <gtest/gtest.h>

#include <string>

namespace waymark::corridor {
namespace {

/// Rows from the top: `#` occupied, `.` free, blank unknown.
MapImage map_of(const std::vector<std::string>& rows) {
  MapImage map{static_cast<int>(rows.front().size()), static_cast<int>(rows.size()), 0.05, {}};
  for (auto row = rows.rbegin(); row != rows.rend(); ++row) {
    for (const char cell : *row) {
      map.cells.push_back(cell == '.'   ? Cell::kFree
                          : cell == '#' ? Cell::kOccupied
                                        : Cell::kUnknown);
    }
  }
  return map;
}

TEST(LargestFreeRegion, HasFreeCellsOnly) {
  EXPECT_EQ(largest_free_region(map_of({"#####", "#...#", "#####"})).size(), 3U);
}

TEST(LargestFreeRegion, IsConnectedAcrossEdgesNotCorners) {
  EXPECT_EQ(largest_free_region(map_of({"..#....", "..#....", "##.#...", "      ."})).size(), 12U);
}

TEST(LargestFreeRegion, OfAMapWithoutFreeCellsIsEmpty) {
  EXPECT_TRUE(largest_free_region(map_of({"# #", "###"})).empty());
}

}  // namespace
}  // namespace waymark::corridor
