// SPDX-License-Identifier: BSD-3-Clause
// Places that beams pass through.
#include "slam/core/mapping/seen_through.hpp"

#include "slam/core/mapping/moving_beams.hpp"

#include <gtest/gtest.h>

namespace waymark {
namespace {

constexpr double kCell_m = 0.05;

/// Free from x = 0 to 1 m and y = 0 to 1 m, but for a wall along x = 0.5 m.
GridMap room_with_a_wall() {
  GridMap map{GridFrame::centred_on_map_origin(kCell_m), {}, {}};
  for (int x = 0; x < 20; ++x) {
    for (int y = 0; y < 20; ++y) {
      OccupancyCell& cell = map.occupancy.edit(map.frame.cell_of({x * kCell_m, y * kCell_m}));
      cell.visits = 20;
      cell.hits = x == 10 ? 15 : 1;
    }
  }
  return map;
}

TEST(SeenThrough, FreeSpaceIsSeenThroughAndWallsAreNot) {
  const GridMap map = room_with_a_wall();
  EXPECT_TRUE(is_seen_through(map, {0.2, 0.5}));
  EXPECT_FALSE(is_seen_through(map, {0.5, 0.5}));
}

TEST(SeenThrough, CellsNextToAWallAreNotSeenThrough) {
  const GridMap map = room_with_a_wall();
  EXPECT_FALSE(is_seen_through(map, {0.45, 0.5}));
  EXPECT_TRUE(is_seen_through(map, {0.4, 0.5}));
}

TEST(SeenThrough, PointsWithinReachOfAWallAreNotSeenThrough) {
  const GridMap map = room_with_a_wall();
  EXPECT_TRUE(is_seen_through(map, {0.3, 0.5}, 0.12));
  EXPECT_FALSE(is_seen_through(map, {0.3, 0.5}, 0.17));
}

TEST(SeenThrough, UnmappedAndEdgeCellsAreNotSeenThrough) {
  const GridMap map = room_with_a_wall();
  EXPECT_FALSE(is_seen_through(map, {3.0, 0.5}));
  EXPECT_FALSE(is_seen_through(map, {0.0, 0.5}));  // at the edge of what was seen
}

Eigen::Matrix3d sigmas(double m, double rad) {
  return Eigen::Vector3d{m * m, m * m, rad * rad}.asDiagonal();
}

TEST(MovingBeams, ABeamThatEndsInFreeSpaceIsLeftOut) {
  const std::vector<Eigen::Vector2d> points{{0.5, 0.3}, {0.25, 0.5}, {0.5, 0.6}};
  const auto standing = without_moving(points, room_with_a_wall(), {}, sigmas(0.01, 0.01));
  ASSERT_EQ(standing.size(), 2U);
  EXPECT_EQ(standing[0], points[0]);
  EXPECT_EQ(standing[1], points[2]);
}

TEST(MovingBeams, ABeamThatMayEndOnAWallIsKept) {
  const std::vector<Eigen::Vector2d> points{{0.5, 0.3}, {0.35, 0.5}, {0.5, 0.6}};
  EXPECT_EQ(without_moving(points, room_with_a_wall(), {}, sigmas(0.01, 0.01)).size(), 2U);
  EXPECT_EQ(without_moving(points, room_with_a_wall(), {}, sigmas(0.05, 0.01)).size(), 3U);
}

TEST(MovingBeams, ManyBeamsOnSomebodyCloseByAreLeftOut) {
  std::vector<Eigen::Vector2d> points{{0.5, 0.3}, {0.5, 0.6}};
  for (int i = 0; i < 10; ++i)
    points.emplace_back(0.25, 0.5);
  const auto standing = without_moving(points, room_with_a_wall(), {}, sigmas(0.01, 0.01));
  EXPECT_EQ(standing.size(), 2U);
}

TEST(MovingBeams, IfMostOfTheOutlineLiesInFreeSpaceAllAreKept) {
  const std::vector<Eigen::Vector2d> points{{0.2, 0.3}, {0.25, 0.5}, {0.5, 0.6}};
  EXPECT_EQ(without_moving(points, room_with_a_wall(), {}, sigmas(0.01, 0.01)).size(), 3U);
}

}  // namespace
}  // namespace waymark
