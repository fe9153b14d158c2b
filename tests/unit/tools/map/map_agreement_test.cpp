// SPDX-License-Identifier: BSD-3-Clause
// Whether two maps are of one building: laid over each other, and merged.
#include "map/map_agreement.hpp"

#include "map/map_commands.hpp"
#include "map/map_merge.hpp"
#include "slam/map_file.hpp"
#include "unit/tools/temporary_folder.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

namespace waymark {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

constexpr double kLength_m = 20.0;
constexpr double kMarkerSigma_m = 0.005;

/// A corridor from x = 0 on, with opposite markers every four metres.
struct Corridor {
  double width_m{2.0};
  double spacing_m{4.0};
  Se2 map_from_world{};
};

Landmark marker_at(int id, const Se2& map_from_marker) {
  Landmark landmark;
  landmark.id = id;
  landmark.map_from_marker = map_from_marker;
  landmark.covariance = kMarkerSigma_m * kMarkerSigma_m * Eigen::Matrix3d::Identity();
  landmark.sightings = 10;
  return landmark;
}

MapSnapshot map_of(const Corridor& corridor) {
  MapSnapshot map;
  map.grid.frame = GridFrame::centred_on_map_origin(0.05);
  const double half_m = 0.5 * corridor.width_m;
  constexpr double kStep_m = 0.02;
  for (double x_m = 0.0; x_m < kLength_m; x_m += kStep_m) {
    for (double y_m = -half_m; y_m < half_m + 0.5 * kStep_m; y_m += kStep_m) {
      const Eigen::Vector2d point = corridor.map_from_world * Eigen::Vector2d{x_m, y_m};
      const bool is_wall = std::abs(y_m) > half_m - 0.5 * kStep_m;
      OccupancyCell& cell = map.grid.occupancy.edit(map.grid.frame.cell_of(point));
      if (is_wall || cell.hits == 0) cell = {is_wall ? 10U : 0U, 10U};
    }
  }
  int id = 0;
  for (double x_m = 2.0; x_m < kLength_m; x_m += corridor.spacing_m)
    for (const double side : {1.0, -1.0})
      map.landmarks.push_back(
          marker_at(id++, corridor.map_from_world * Se2{x_m, side * half_m, -side * M_PI_2}));
  return map;
}

void move(MapSnapshot& map, std::size_t index, const Eigen::Vector2d& by_m) {
  Se2& pose = map.landmarks.at(index).map_from_marker;
  pose = Se2{Eigen::Vector2d{pose.translation() + by_m}, pose.theta()};
}

class Merge : public ::testing::Test {
 protected:
  std::string merge(const MapSnapshot& a, const MapSnapshot& b,
                    MergeCheck check = MergeCheck::kRefuse) const {
    const MapFileInfo info{"6x6_250", 0.4};
    write_map_file(file("a"), a, info);
    write_map_file(file("b"), b, info);
    std::filesystem::remove(file("out"));
    try {
      return merge_maps(file("a"), file("b"), file("out"), check);
    } catch (const SetupError& error) {
      EXPECT_FALSE(std::filesystem::exists(file("out")));
      return error.what();
    }
  }

  std::filesystem::path file(const std::string& name) const {
    return folder_.path() / (name + ".map.lcm");
  }

 private:
  evaluate::TemporaryFolder folder_{};
};

TEST_F(Merge, MapsOfOneBuildingAgreeInAllMarkersAndWalls) {
  const Corridor turned{.map_from_world = {3.0, -2.0, 0.7}};
  EXPECT_THAT(merge(map_of({}), map_of(turned)),
              AllOf(HasSubstr("10 of 10 shared markers agree; 0 % of the walls")));
}

TEST_F(Merge, MarkersThatWereMovedAreNamed) {
  MapSnapshot later = map_of({});
  move(later, 3, {1.0, 0.0});
  move(later, 6, {0.25, 0.0});
  EXPECT_THAT(merge(map_of({}), later),
              HasSubstr("8 of 10 shared markers agree; not 3 (1.00 m apart), 6 (0.25 m apart)"));
}

TEST_F(Merge, MapsWhoseMarkersMostlyDisagreeAreRefusedUnlessForced) {
  const MapSnapshot other = map_of({.spacing_m = 3.3});
  EXPECT_THAT(merge(map_of({}), other),
              AllOf(HasSubstr("do not show the same building: only 2 of 10 shared markers agree"),
                    HasSubstr("--force")));
  EXPECT_THAT(merge(map_of({}), other, MergeCheck::kForce), HasSubstr("merged by --force"));
  EXPECT_TRUE(std::filesystem::exists(file("out")));
}

// On one wall, all markers of the wide corridor hang as in the narrow one.
TEST_F(Merge, ACorridorThatIsWiderIsRefusedByItsWallsAlone) {
  MapSnapshot narrow = map_of({});
  MapSnapshot wide = map_of({.width_m = 3.0});
  for (MapSnapshot* map : {&narrow, &wide})
    std::erase_if(map->landmarks, [](const Landmark& marker) { return marker.id % 2 == 1; });
  for (const auto& said : {merge(narrow, wide), merge(wide, narrow)})
    EXPECT_THAT(said, AllOf(HasSubstr("of the walls of one map stand in the free space"),
                            HasSubstr("5 of 5 shared markers agree")));
}

TEST_F(Merge, AMapThatOverlapsByItsEndOnlyIsMerged) {
  const Corridor next{.map_from_world = {12.0, 0.0, 0.0}};
  MapSnapshot east = map_of(next);
  for (Landmark& marker : east.landmarks)
    marker.id += 6;  // x = 14 m in both
  EXPECT_THAT(merge(map_of({}), east), HasSubstr("4 of 4 shared markers agree; 0 % of the walls"));
}

TEST(SharedMarker, AgreesWithinItsCovarianceButNeverBeyondAWall) {
  SharedMarker marker{.id = 3, .in_b = {0.2, 0.0}};
  EXPECT_FALSE(marker.agrees(Se2{}));
  marker.covariance_a(0, 0) = 0.01;  // sigma of 0.1 m along x
  EXPECT_TRUE(marker.agrees(Se2{}));
  marker.in_b = {0.0, 0.2};
  EXPECT_FALSE(marker.agrees(Se2{})) << "the sigma is along x";
  EXPECT_TRUE(marker.agrees(Se2{Eigen::Vector2d{0.2, -0.2}, 0.0}));
  marker.covariance_a = Eigen::Matrix2d::Identity();
  EXPECT_TRUE(marker.agrees(Se2{}));
  marker.in_b = {0.0, 0.4};
  EXPECT_FALSE(marker.agrees(Se2{})) << "a sigma of a metre";
}

// A mean of the two places would be wrong by half, with a small covariance.
TEST(Merged, OfAMarkerThatWasMovedALittleTheLaterPlaceCounts) {
  MapSnapshot a = map_of({});
  MapSnapshot b = map_of({});
  move(b, 6, {0.25, 0.0});
  const Eigen::Vector2d before = a.landmarks[6].map_from_marker.translation();
  for (const bool is_b_later : {true, false}) {
    a.landmarks[6].last_seen = timestamp_from_us(is_b_later ? 1 : 2);
    b.landmarks[6].last_seen = timestamp_from_us(is_b_later ? 2 : 1);
    const MapSnapshot both = merged(a, b, Se2{});
    ASSERT_EQ(both.landmarks.size(), a.landmarks.size());
    EXPECT_NEAR(both.landmarks[6].map_from_marker.x() - before.x(), is_b_later ? 0.25 : 0.0, 1e-9);
  }
}

}  // namespace
}  // namespace waymark
