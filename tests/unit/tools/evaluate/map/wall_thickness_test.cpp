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

TEST(WallThickness, WallsOfOneCellHaveAThicknessOfOneCell) {
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

TEST(WallThickness, AGapOfThreeCellsIsFilledAndOneOfFourIsNot) {
  const std::string row = "##########";
  const std::string gap = "..........";
  EXPECT_EQ(wall_thickness_cells(picture({row, gap, gap, gap, row})), 5);
  EXPECT_EQ(wall_thickness_cells(picture({row, gap, gap, gap, gap, row})), 1);
}

TEST(WallThickness, AWallNearAnEdgeIsNotJoinedToTheOppositeEdge) {
  EXPECT_EQ(wall_thickness_cells(picture({"#......#..",  //
                                          "#......#..",  //
                                          "#......#..",  //
                                          "#......#..",  //
                                          "#......#..",  //
                                          "#......#.."})),
            1);
}

TEST(WallThickness, AWallAtAnEdgeIsAsThickAsElsewhere) {
  EXPECT_EQ(wall_thickness_cells(picture({"....", "####", "####"})), 2);
  EXPECT_EQ(wall_thickness_cells(picture({"##..", "##..", "##..", "##.."})), 2);
}

TEST(WallThickness, FewerThanHalfAPercentOfTheCellsAreIgnored) {
  const auto wall_with_a_bump = [](std::size_t length) {
    std::string bump(length, '.');
    bump[length / 2] = bump[length / 2 + 1] = '#';  // one square of two by two cells
    return wall_thickness_cells(picture({bump, std::string(length, '#')}));
  };
  EXPECT_EQ(wall_with_a_bump(190), 2);  // 1 of 192
  EXPECT_EQ(wall_with_a_bump(210), 1);  // 1 of 212
}

TEST(WallThickness, OfAFilledBlockIsAtMostTwentyCells) {
  EXPECT_EQ(wall_thickness_cells(picture(std::vector<std::string>(19, std::string(30, '#')))), 19);
  EXPECT_EQ(wall_thickness_cells(picture(std::vector<std::string>(30, std::string(30, '#')))), 20);
}

TEST(WallThickness, WithoutWallsThereIsNoThickness) {
  EXPECT_EQ(wall_thickness_cells(picture({"....", "...."})), 0);
}

}  // namespace
}  // namespace waymark::evaluate
