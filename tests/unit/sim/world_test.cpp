// SPDX-License-Identifier: BSD-3-Clause
#include "sim/core/world/world.hpp"

#include "sim/core/world/marker_picture.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <opencv2/aruco.hpp>

#include <cmath>

namespace waymark {
namespace {

using ::testing::DoubleNear;
using ::testing::ElementsAre;

World corridor_world(const WorldConfig& config = {}, const MarkerLayoutConfig& markers = {},
                     std::int64_t seed = 1) {
  return build_world(config, markers, plate_size_m({}), seed);
}

std::vector<double> stations_of(const World& world, double side) {
  std::vector<double> stations;
  for (const MarkerPlate& marker : world.markers)
    if (marker.centre_m.y() * side > 0.0) stations.push_back(marker.centre_m.x());
  return stations;
}

TEST(World, TheDefaultHas24MarkersFrom4To48MetresLeftBeforeRight) {
  const World world = corridor_world();

  ASSERT_EQ(world.markers.size(), 24U);
  EXPECT_EQ(world.markers[0].id, 0);
  EXPECT_EQ(world.markers[0].centre_m.x(), 4.0);
  EXPECT_GT(world.markers[0].centre_m.y(), 0.0);
  EXPECT_EQ(world.markers[1].id, 1);
  EXPECT_EQ(world.markers[1].centre_m.x(), 4.0);
  EXPECT_LT(world.markers[1].centre_m.y(), 0.0);
  EXPECT_EQ(world.markers[23].id, 23);
  EXPECT_EQ(world.markers[23].centre_m.x(), 48.0);
}

TEST(World, MarkersHangOnTheirWallAndFaceTheMiddle) {
  for (const MarkerPlate& marker : corridor_world().markers) {
    EXPECT_NEAR(std::abs(marker.centre_m.y()), 1.0, 0.005);
    EXPECT_NEAR(std::sin(marker.yaw_rad), marker.centre_m.y() > 0 ? -1.0 : 1.0, 1e-12);
  }
}

TEST(World, StaggeredMarkersOnTheRightWallAreShiftedByHalfASpacing) {
  MarkerLayoutConfig markers{};
  markers.layout = MarkerLayout::kStaggered;
  markers.last_m = 12.0;

  const World world = corridor_world({}, markers);

  EXPECT_THAT(stations_of(world, 1.0), ElementsAre(4.0, 8.0, 12.0));
  EXPECT_THAT(stations_of(world, -1.0), ElementsAre(6.0, 10.0));
  EXPECT_EQ(world.markers.back().id, 4);
}

TEST(World, MarkerPlacesAreNotAffectedByRounding) {
  MarkerLayoutConfig markers{};
  markers.first_m = 0.1;
  markers.spacing_m = 0.1;
  markers.last_m = 0.3;  // 0.1 + 2 * 0.1 is a little more than 0.3

  EXPECT_EQ(place_count({}, markers, 0.05), 6U);
}

TEST(World, ExplicitIdsAreUsedAndRepeatedIdsGetInstanceNumbers) {
  MarkerLayoutConfig markers{};
  markers.last_m = 8.0;
  markers.ids = {7, 7, 3, 7};

  const World world = corridor_world({}, markers);

  std::vector<int> instances;
  for (const MarkerPlate& marker : world.markers)
    instances.push_back(marker.instance);
  EXPECT_THAT(instances, ElementsAre(0, 1, 0, 2));
}

TEST(World, WallsEncloseTheFreeSpaceOnTheirLeft) {
  WorldConfig config{};
  config.length_m = 10.0;
  config.width_m = 3.0;
  const World world = corridor_world(config);
  const Eigen::Vector2d inside{5.0, 0.0};

  ASSERT_EQ(world.walls.size(), 4U);
  for (std::size_t i = 0; i < world.walls.size(); ++i) {
    const Wall& wall = world.walls[i];
    EXPECT_EQ(wall.to_m, world.walls[(i + 1) % 4].from_m);
    const Eigen::Vector2d along = wall.to_m - wall.from_m;
    const Eigen::Vector2d to_inside = inside - wall.from_m;
    EXPECT_GT(along.x() * to_inside.y() - along.y() * to_inside.x(), 0.0);
  }
}

TEST(MarkerPicture, OpenCvReadsIt) {
  const MarkerPrint print{};
  std::vector<int> ids;
  std::vector<std::vector<cv::Point2f>> corners;

  cv::aruco::detectMarkers(marker_picture(print, 77),
                           cv::aruco::getPredefinedDictionary(cv::aruco::DICT_6X6_250), corners,
                           ids);

  EXPECT_THAT(ids, ElementsAre(77));
}

TEST(MarkerPicture, ThePlateIsTheBlackSquareAndTheQuietZoneOnBothSides) {
  MarkerPrint print{};
  EXPECT_THAT(plate_size_m(print), DoubleNear(0.6, 1e-12));  // 8 modules are 0.4 m, 12 are 0.6 m
  print.quiet_zone_modules = 0.0;
  EXPECT_EQ(plate_size_m(print), 0.4);
  EXPECT_EQ(blank_picture(print).size(), marker_picture(print, 0).size());
}

TEST(MarkerPicture, UnknownDictionariesHaveNoSize) {
  EXPECT_EQ(dictionary_size("DICT_6X6_250"), 250);
  EXPECT_EQ(dictionary_size("DICT_APRILTAG_36h11"), 587);
  EXPECT_EQ(dictionary_size("DICT_9X9"), std::nullopt);
}

}  // namespace
}  // namespace waymark
