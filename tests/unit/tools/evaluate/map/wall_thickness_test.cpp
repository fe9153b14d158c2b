// SPDX-License-Identifier: BSD-3-Clause
// Thickness of walls in maps drawn as pictures.
#include "evaluate/map/wall_thickness.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace waymark::evaluate {
namespace {

/// '#' occupied, '.' free; the upper row is drawn first.
MapImage picture(const std::vector<std::string>& rows) {
  MapImage map{static_cast<int>(rows.front().size()), static_cast<int>(rows.size()), 0.05, {}};
  for (auto row = rows.rbegin(); row != rows.rend(); ++row) {
    for (const char c : *row)
      map.cells.push_back(c == '#' ? Cell::kOccupied : Cell::kFree);
  }
  return map;
}

TEST(WallThickness, OfARoomWithThinWalls) {
  EXPECT_EQ(wall_thickness_cells(picture({"##########",  //
                                          "#........#",  //
                                          "#........#",  //
                                          "#........#",  //
                                          "#........#",  //
                                          "##########"})),
            1);
}

TEST(WallThickness, CornersAndCrossingsOfTwoCellsAreTwo) {
  EXPECT_EQ(wall_thickness_cells(picture({".....##.....",  //
                                          ".....##.....",  //
                                          ".....##.....",  //
                                          "############",  //
                                          "############",  //
                                          ".....##.....",  //
                                          ".....##.....",  //
                                          ".....##....."})),
            2);
}

TEST(WallThickness, ADoubledWallIsThick) {
  EXPECT_EQ(wall_thickness_cells(picture({"..........",  //
                                          "##########",  //
                                          "..........",  //
                                          "..........",  //
                                          "##########",  //
                                          ".........."})),
            4);
}

TEST(WallThickness, SeparateWallsAreMeasuredSeparately) {
  EXPECT_EQ(wall_thickness_cells(picture({"##########",  //
                                          "..........",  //
                                          "..........",  //
                                          "..........",  //
                                          "..........",  //
                                          "##########"})),
            1);
}

TEST(WallThickness, WithoutWallsThereIsNoThickness) {
  EXPECT_EQ(wall_thickness_cells(picture({"....", "...."})), 0);
}

}  // namespace
}  // namespace waymark::evaluate
