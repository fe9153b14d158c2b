// SPDX-License-Identifier: BSD-3-Clause
#include "map/wall_alignment.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace waymark {
namespace {

struct Wall {
  Eigen::Vector2d from;
  Eigen::Vector2d to;
};

/// A map of walls, with poses along `way`.
MapSnapshot map_of(const std::vector<Wall>& walls, const std::vector<Se2>& way,
                   const Se2& map_from_world) {
  MapSnapshot map;
  map.grid.frame = GridFrame::centred_on_map_origin(0.05);
  for (const Wall& wall : walls) {
    const double length_m = (wall.to - wall.from).norm();
    const int steps = static_cast<int>(length_m / 0.01);
    for (int i = 0; i <= steps; ++i) {
      const Eigen::Vector2d point =
          map_from_world * Eigen::Vector2d{wall.from + (wall.to - wall.from) * i / steps};
      map.grid.occupancy.edit(map.grid.frame.cell_of(point)) = {9, 10};
      map.walls.add(point, 0);
    }
  }
  for (const Se2& pose : way)
    map.graph.poses.push_back(map_from_world * pose);
  return map;
}

/// Three rooms side by side, each with different niches.
std::vector<Wall> rooms() {
  return {{{0, 0}, {18, 0}},         {{0, 5}, {18, 5}},          {{0, 0}, {0, 5}},
          {{18, 0}, {18, 5}},        {{6, 0}, {6, 3.2}},         {{12, 2}, {12, 5}},
          {{1, 5}, {1, 4}},          {{2.3, 5}, {2.3, 4}},       {{1, 4}, {2.3, 4}},
          {{4, 0}, {4, 0.8}},        {{8, 5}, {8, 3.7}},         {{9.1, 0}, {9.1, 1.4}},
          {{9.1, 1.4}, {10.4, 1.4}}, {{10.4, 1.4}, {10.4, 0}},   {{14, 0}, {14, 1.1}},
          {{15.2, 5}, {15.2, 4.4}},  {{15.2, 4.4}, {16.9, 4.4}}, {{16.9, 4.4}, {16.9, 5}}};
}

std::vector<Se2> way_between(double from_x_m, double to_x_m) {
  std::vector<Se2> way;
  for (double x_m = from_x_m; x_m <= to_x_m; x_m += 0.5)
    way.emplace_back(x_m, 2.6, 0.0);
  return way;
}

TEST(WallAlignment, FindsWhereTheRoomsOfOneMapAreInAnother) {
  const Se2 b_from_world{-3.0, 7.0, 2.1};
  const MapSnapshot a = map_of(rooms(), way_between(2.0, 16.0), Se2{});
  const MapSnapshot b = map_of(rooms(), way_between(7.0, 16.0), b_from_world);
  const auto alignment = align_by_walls(a, b);
  ASSERT_TRUE(alignment);
  EXPECT_GE(alignment->shared, 2U);
  const Se2 off = alignment->a_from_b * b_from_world;
  EXPECT_NEAR(off.x(), 0.0, 0.05);
  EXPECT_NEAR(off.y(), 0.0, 0.05);
  EXPECT_NEAR(off.theta(), 0.0, 0.01);
}

TEST(WallAlignment, ABareCorridorGivesNoAlignment) {
  const std::vector<Wall> corridor{{{0, 0}, {30, 0}}, {{0, 2}, {30, 2}}};
  const MapSnapshot a = map_of(corridor, way_between(5.0, 25.0), Se2{});
  const MapSnapshot b = map_of(corridor, way_between(5.0, 25.0), {1.0, 2.0, 0.5});
  EXPECT_FALSE(align_by_walls(a, b));
}

TEST(WallAlignment, MapsOfDifferentBuildingsGiveNoAlignment) {
  const std::vector<Wall> other{{{0, 0}, {7, 0}}, {{7, 0}, {7, 9}},  {{7, 9}, {0, 9}},
                                {{0, 9}, {0, 0}}, {{3, 0}, {3, 4}},  {{3, 6}, {3, 9}},
                                {{7, 5}, {5, 5}}, {{5, 5}, {5, 6.3}}};
  const MapSnapshot a = map_of(rooms(), way_between(2.0, 16.0), Se2{});
  const MapSnapshot b = map_of(other, way_between(1.0, 6.0), Se2{});
  EXPECT_FALSE(align_by_walls(a, b));
  EXPECT_FALSE(align_by_walls(MapSnapshot{}, MapSnapshot{}));
}

}  // namespace
}  // namespace waymark
