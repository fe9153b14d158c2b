// SPDX-License-Identifier: BSD-3-Clause
// Layouts, openings, boxes, missing and moved markers: geometry compared with rays in MuJoCo's
// model.
#include "common/geometry/angle.hpp"
#include "sim/core/sensors/lidar.hpp"
#include "sim/core/world/mjcf.hpp"
#include "sim/core/world/world.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace waymark {
namespace {

using ::testing::ElementsAre;

constexpr double kPlate_m = 0.6;
constexpr double kEyeHeight_m = 0.15;

WorldConfig ring_20_by_14() {
  WorldConfig config{};
  config.layout = Layout::kRing;
  config.length_m = 20.0;
  config.second_length_m = 14.0;
  return config;
}

Physics physics_of(const WorldConfig& config) {
  MjcfOptions options{};
  options.world_from_start = {1.0, 0.0, 0.0};
  return Physics{to_mjcf(build_world(config, {}, kPlate_m, 1), {}, options)};
}

double ray_m(const Physics& physics, double x_m, double y_m, double direction_deg) {
  const double rad = radians(direction_deg);
  return wall_distance_m(physics, {x_m, y_m, kEyeHeight_m}, {std::cos(rad), std::sin(rad), 0.0});
}

std::vector<int> ids_of(const World& world) {
  std::vector<int> ids;
  for (const MarkerPlate& marker : world.markers)
    ids.push_back(marker.id);
  return ids;
}

TEST(Layout, TheCornerOfAnLHasItsOuterAndInnerWallsAtTheConfiguredPlaces) {
  WorldConfig config{};
  config.layout = Layout::kL;
  config.length_m = 10.0;
  config.second_length_m = 8.0;
  const Physics physics = physics_of(config);
  EXPECT_NEAR(ray_m(physics, 5.0, 0.0, 0.0), 5.0, 1e-6);    // the outer wall behind the corner
  EXPECT_NEAR(ray_m(physics, 5.0, 0.0, 90.0), 1.0, 1e-6);   // the inner wall
  EXPECT_NEAR(ray_m(physics, 9.0, 0.0, 90.0), 7.0, 1e-6);   // down the second corridor
  EXPECT_NEAR(ray_m(physics, 9.0, 4.0, 180.0), 1.0, 1e-6);  // its inner wall
  EXPECT_NEAR(ray_m(physics, 9.0, 4.0, 0.0), 1.0, 1e-6);
}

TEST(Layout, ARingHasABlockInside) {
  const Physics physics = physics_of(ring_20_by_14());
  EXPECT_NEAR(ray_m(physics, 10.0, 0.0, 90.0), 1.0, 1e-6);     // block from the south
  EXPECT_NEAR(ray_m(physics, 10.0, 12.0, -90.0), 1.0, 1e-6);   // from the north
  EXPECT_NEAR(ray_m(physics, 1.0, 6.0, 0.0), 1.0, 1e-6);       // from the west
  EXPECT_NEAR(ray_m(physics, 19.0, 6.0, 180.0), 1.0, 1e-6);    // from the east
  EXPECT_NEAR(ray_m(physics, 19.0, 0.0, 90.0), 13.0, 1e-6);    // along the second corridor
  EXPECT_NEAR(ray_m(physics, 19.0, 12.0, 180.0), 19.0, 1e-6);  // along the third
}

TEST(Layout, NoRayLeavesTheWalls) {
  WorldConfig config = ring_20_by_14();
  config.openings = {{2, Side::kRight, 10.0, 0.9, 3.0, 4.0}, {1, Side::kLeft, 6.0}};
  const Physics physics = physics_of(config);
  for (int degree = 0; degree < 360; ++degree) {
    EXPECT_LT(ray_m(physics, 10.0, 12.0, degree), 25.0) << degree;
    EXPECT_LT(ray_m(physics, 19.0, 6.0, degree), 25.0) << degree;
  }
}

TEST(Layout, RecessesAndRoomsOpenFromTheirCorridor) {
  WorldConfig config{};
  config.length_m = 20.0;
  config.openings = {{0, Side::kLeft, 6.0}, {0, Side::kRight, 12.0, 0.9, 3.0, 5.0}};
  const Physics physics = physics_of(config);
  EXPECT_NEAR(ray_m(physics, 6.0, 0.0, 90.0), 1.1, 1e-6);
  EXPECT_NEAR(ray_m(physics, 6.5, 0.0, 90.0), 1.0, 1e-6);          // beside the recess
  EXPECT_NEAR(ray_m(physics, 12.0, 0.0, -90.0), 1.2 + 3.0, 1e-6);  // through the doorway
  EXPECT_NEAR(ray_m(physics, 12.0, -2.0, 0.0), 2.5, 1e-6);         // across the room
  EXPECT_NEAR(ray_m(physics, 14.0, -2.0, 90.0), 0.8, 1e-6);        // back to the partition
  EXPECT_NEAR(ray_m(physics, 12.0, -1.1, 0.0), 0.45, 1e-6);        // the jamb
}

TEST(Layout, OpeningsWithoutAWallAndCrossingRoomsAreReported) {
  WorldConfig config{};
  config.length_m = 20.0;
  config.openings = {{0, Side::kLeft, 6.0}, {0, Side::kLeft, 6.5}};
  EXPECT_EQ(opening_without_wall(config), 1U);
  config.openings = {{0, Side::kLeft, 19.8}};
  EXPECT_EQ(opening_without_wall(config), 0U);
  config.openings = {{1, Side::kLeft, 6.0}};
  EXPECT_EQ(opening_without_wall(config), 0U);
  config.openings = {{0, Side::kLeft, 6.0, 0.9, 3.0, 4.0}, {0, Side::kLeft, 9.0, 0.9, 3.0, 4.0}};
  EXPECT_EQ(opening_without_wall(config), std::nullopt);
  EXPECT_TRUE(walls_cross(outline(config)));
  config.openings.back().centre_m = 11.0;
  EXPECT_FALSE(walls_cross(outline(config)));
}

TEST(Layout, AWallThickerThanTheSolidBehindItReachesIntoFreeSpace) {
  WorldConfig config{};
  config.length_m = 20.0;
  config.openings = {{0, Side::kLeft, 5.0, 1.0, 0.5}, {0, Side::kLeft, 6.1, 1.0, 0.5}};
  EXPECT_EQ(solid_in_free_space(outline(config)), std::nullopt);  // 0.1 m apart, as thick as a wall
  config.openings.back().centre_m = 6.05;
  ASSERT_TRUE(solid_in_free_space(outline(config)));
  EXPECT_NEAR(solid_in_free_space(outline(config))->x(), 5.525, 0.03);

  WorldConfig ring = ring_20_by_14();
  ring.wall_thickness_m = 9.9;  // the block has 16 by 10 m
  EXPECT_EQ(solid_in_free_space(outline(ring)), std::nullopt);
  ring.wall_thickness_m = 10.1;
  EXPECT_TRUE(solid_in_free_space(outline(ring)));
}

TEST(Layout, ClearanceIsNegativeInsideTheBlock) {
  const std::vector<Wall> walls = outline(ring_20_by_14());
  EXPECT_NEAR(clearance_m(walls, {10.0, 0.3}), 0.7, 1e-12);
  EXPECT_NEAR(clearance_m(walls, {10.0, 1.5}), -0.5, 1e-12);
  EXPECT_LT(clearance_m(walls, {10.0, -1.5}), 0.0);
}

TEST(Layout, BoxesAreSolidAndTurned) {
  WorldConfig config{};
  config.length_m = 20.0;
  BoxConfig box{};
  box.x_m = 5.0;
  box.length_m = 1.0;
  box.width_m = 0.2;
  config.boxes = {box};
  EXPECT_NEAR(ray_m(physics_of(config), 3.0, 0.0, 0.0), 1.5, 1e-6);
  config.boxes[0].yaw_deg = 90.0;
  EXPECT_NEAR(ray_m(physics_of(config), 3.0, 0.0, 0.0), 1.9, 1e-6);
}

TEST(Markers, HangOnEveryCorridorAndFaceIntoIt) {
  const std::vector<Wall> walls = outline(ring_20_by_14());
  const World world = build_world(ring_20_by_14(), {}, kPlate_m, 1);
  EXPECT_EQ(world.markers.size(), 26U);  // 4 stations less one inner, 3 and both, and so on
  for (const MarkerPlate& marker : world.markers) {
    const Eigen::Vector2d at_m = marker.centre_m.head<2>();
    const Eigen::Vector2d facing{std::cos(marker.yaw_rad), std::sin(marker.yaw_rad)};
    EXPECT_NEAR(clearance_m(walls, at_m), kPlateThickness_m, 1e-9);
    EXPECT_NEAR(clearance_m(walls, at_m + 0.5 * facing), 0.5 + kPlateThickness_m, 1e-9);
  }
}

TEST(Markers, DoNotHangInDoorways) {
  WorldConfig config{};
  config.openings = {{0, Side::kLeft, 8.0}};
  EXPECT_EQ(place_count({}, {}, kPlate_m), 24U);
  EXPECT_EQ(place_count(config, {}, kPlate_m), 23U);
}

TEST(Markers, AMissingMarkersIdIsNotGivenToAnother) {
  MarkerLayoutConfig markers{};
  markers.last_m = 16.0;
  markers.missing = {0, 3};
  EXPECT_THAT(ids_of(build_world({}, markers, kPlate_m, 1)), ElementsAre(1, 2, 4, 5, 6, 7));
  markers.missing = {};
  markers.keep_every = 2;
  EXPECT_THAT(ids_of(build_world({}, markers, kPlate_m, 1)), ElementsAre(0, 3, 4, 7));
  markers.keep_every = 4;
  EXPECT_THAT(ids_of(build_world({}, markers, kPlate_m, 1)), ElementsAre(0, 5));
}

TEST(Markers, AddedMarkersHangOnTheNearestWall) {
  WorldConfig config{};
  config.openings = {{.side = Side::kLeft, .centre_m = 10.0, .depth_m = 4.0, .room_width_m = 5.0}};
  MarkerLayoutConfig markers{};
  markers.layout = MarkerLayout::kNone;
  const double room_back_m = 1.0 + 2.0 * config.wall_thickness_m + 4.0;
  markers.added = {{7, 20.0, -0.8}, {8, 50.0, 0.1}, {9, 11.0, room_back_m}, {7, 0.2, 0.9}};
  const std::vector<MarkerPlate> plates = build_world(config, markers, kPlate_m, 1).markers;
  ASSERT_EQ(plates.size(), 4U);
  const auto expect_at = [&](std::size_t i, double x_m, double y_m, double yaw_rad) {
    EXPECT_NEAR(plates[i].centre_m.x(), x_m, 1e-9) << i;
    EXPECT_NEAR(plates[i].centre_m.y(), y_m, 1e-9) << i;
    EXPECT_NEAR(wrap_angle(plates[i].yaw_rad - yaw_rad), 0.0, 1e-9) << i;
  };
  const double quarter_rad = 0.5 * std::numbers::pi;
  expect_at(0, 20.0, -1.0 + kPlateThickness_m, quarter_rad);
  expect_at(1, 50.0 - kPlateThickness_m, 0.1, 2.0 * quarter_rad);
  expect_at(2, 11.0, room_back_m - kPlateThickness_m, -quarter_rad);
  expect_at(3, 0.5 * kPlate_m, 1.0 - kPlateThickness_m, -quarter_rad);
  EXPECT_EQ(plates[3].instance, 1);
}

TEST(Markers, MarkersWithTheSameIdGetInstanceNumbers) {
  MarkerLayoutConfig markers{};
  markers.last_m = 8.0;
  markers.ids = {7};
  const World world = build_world({}, markers, kPlate_m, 1);
  EXPECT_THAT(ids_of(world), ElementsAre(7, 7, 7, 7));
  EXPECT_EQ(world.markers[3].instance, 3);
}

TEST(Markers, ASeededShareOfMarkersIsMissing) {
  MarkerLayoutConfig markers{};
  markers.missing_share = 0.5;
  std::size_t hanging = 0;
  for (int seed = 1; seed <= 40; ++seed)
    hanging += build_world({}, markers, kPlate_m, seed).markers.size();
  // The count is binomial, 960 trials with probability 0.5: 480, standard deviation 15.5.
  EXPECT_NEAR(static_cast<double>(hanging), 480.0, 4 * 15.5);
  EXPECT_NE(ids_of(build_world({}, markers, kPlate_m, 1)),
            ids_of(build_world({}, markers, kPlate_m, 2)));
}

}  // namespace
}  // namespace waymark
