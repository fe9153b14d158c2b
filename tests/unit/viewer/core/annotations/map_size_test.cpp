// SPDX-License-Identifier: BSD-3-Clause
#include "viewer/core/annotations/map_size.hpp"

#include "unit/viewer/drawn_scene.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace waymark::viewer {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

TEST(FreeExtent, CountsCellsBetweenTheWalls) {
  const auto extent = free_extent(drawn_map({
                                      "########",
                                      "#......#",
                                      "#......#",
                                      "#......#",
                                      "########",
                                  }),
                                  Se2{}, {});
  ASSERT_TRUE(extent);
  EXPECT_NEAR(extent->length_m, 0.3, 1e-12);
  EXPECT_NEAR(extent->width_m, 0.15, 1e-12);
  EXPECT_FALSE(free_extent(GridMap{}, Se2{}, {}));
}

TEST(CorridorLength, EqualsTheMeasurementOfEvaluate) {
  // 1000 free cells lie between the walls, so their centres are 1001 cells apart.
  const auto length = corridor_length(room(-1, -1, 49, 1), {});
  ASSERT_TRUE(length);
  EXPECT_NEAR(length->length_px, 1001.0, 1e-9);
  EXPECT_THAT(size_text(room(-1, -1, 49, 1), Se2{}, {}),
              StartsWith("corridor 50.05 m long (1001 px of 0.05 m)"));
}

TEST(CorridorLength, FollowsTheThresholdsOfTheMapFile) {
  GridMap map = room(-1, -1, 49, 1);  // free cells have 3 %, walls 96 %
  EXPECT_TRUE(corridor_length(map, {.occupied = 0.65, .free = 0.1}));
  EXPECT_FALSE(corridor_length(map, {.occupied = 0.65, .free = 0.01})) << "no cell is free";
}

TEST(CorridorLength, RoomsAndBuildingsHaveOnlyAnExtent) {
  EXPECT_FALSE(corridor_length(room(-2, -2, 3, 3), {}));
  EXPECT_EQ(size_text(room(-2, -2, 3, 3), Se2{}, {}), "free space 5.0 m x 5.0 m");
  EXPECT_EQ(size_text(GridMap{}, Se2{}, {}), "no map yet");

  GridMap crossing = room(-20, -20, 20, 20);  // two corridors of 2 m that cross
  for (int row = 0; row < crossing.occupancy_percent.rows; ++row) {
    for (int column = 0; column < crossing.occupancy_percent.cols; ++column) {
      const Eigen::Vector2d cell = crossing.cell_centre_m(row, column).cwiseAbs();
      if (cell.minCoeff() > 1.0) crossing.occupancy_percent(row, column) = -1;
    }
  }
  EXPECT_FALSE(corridor_length(crossing, {}));
}

TEST(CorridorLength, AMissingEndWallIsNamed) {
  GridMap map = room(-1, -1, 49, 1);
  map.occupancy_percent.col(map.occupancy_percent.cols - 2) = schar{-1};
  EXPECT_THAT(size_text(map, Se2{}, {}), HasSubstr(", end wall missing"));
}

}  // namespace
}  // namespace waymark::viewer
