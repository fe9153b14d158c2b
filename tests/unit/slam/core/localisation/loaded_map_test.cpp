// SPDX-License-Identifier: BSD-3-Clause
#include "slam/core/localisation/loaded_map.hpp"

#include "support/round_room.hpp"

#include <gtest/gtest.h>

#include <memory>

namespace waymark {
namespace {

constexpr double kRoom_m = 2.0;  // radius
constexpr MarkerBook::KnownMarkers kNoMarkers{};

Observation view_of_round_wall(double radius_m) {
  Observation observation;
  observation.beams = test::in_a_round_room(radius_m);
  return observation;
}

LoadedMap round_room() {
  auto map = std::make_shared<MapSnapshot>();
  map->grid = test::map_of_a_round_room(kRoom_m);
  return LoadedMap{map};
}

const Observation kRight = view_of_round_wall(kRoom_m);
const Observation kThroughWalls = view_of_round_wall(1.5 * kRoom_m);

void compare(LoadedMap& map, const Observation& observation, int times) {
  for (int i = 0; i < times; ++i)
    map.compare(observation, {}, false, kNoMarkers);
}

TEST(LoadedMap, ScansThatCrossItsWallsRefuteAnAssumedPose) {
  LoadedMap map = round_room();
  compare(map, kThroughWalls, 9);
  EXPECT_FALSE(map.is_pose_refuted());  // too few
  compare(map, kThroughWalls, 1);
  EXPECT_TRUE(map.is_pose_refuted());
  map.forget_votes();
  EXPECT_FALSE(map.is_pose_refuted());
}

TEST(LoadedMap, ScansThatFitDoNotRefuteThePose) {
  LoadedMap map = round_room();
  compare(map, kRight, 20);
  EXPECT_FALSE(map.is_pose_refuted());
  EXPECT_EQ(map.fit().scans, 20);
  EXPECT_EQ(map.fit().contradicting, 0);
}

TEST(LoadedMap, OldScansAreOutvoted) {
  LoadedMap map = round_room();
  compare(map, kRight, 1000);
  compare(map, kThroughWalls, 20);
  EXPECT_TRUE(map.is_pose_refuted());
}

TEST(LoadedMap, APoseThatMarkersShowIsNotRefuted) {
  LoadedMap map = round_room();
  map.trust(PlaceTrust::kKnown);
  compare(map, kThroughWalls, 30);
  EXPECT_FALSE(map.is_pose_refuted());
  EXPECT_EQ(map.fit().refuting, 30);
}

TEST(LoadedMap, WallsConfirmAPoseUnlessBeamsCrossThem) {
  LoadedMap map = round_room();
  map.compare(kThroughWalls, {}, true, kNoMarkers);
  EXPECT_FALSE(map.is_confirmed());
  map.compare(kRight, {}, true, kNoMarkers);
  EXPECT_TRUE(map.is_confirmed());
  map.trust(PlaceTrust::kAssumed);
  EXPECT_FALSE(map.is_confirmed());
  EXPECT_TRUE(map.was_confirmed());
}

TEST(LoadedMap, MostMarkersElsewhereShowAnotherBuilding) {
  LoadedMap map = round_room();
  map.compare(kRight, {}, false, {3, 3});
  EXPECT_FALSE(map.is_of_another_building());
  map.compare(kRight, {}, false, {3, 4});
  EXPECT_TRUE(map.is_of_another_building());
}

TEST(LoadedMap, MostScansThroughWallsShowAnotherBuilding) {
  LoadedMap map = round_room();
  map.trust(PlaceTrust::kKnown);
  compare(map, kThroughWalls, 39);
  EXPECT_FALSE(map.is_of_another_building());  // too few
  compare(map, kThroughWalls, 1);
  EXPECT_TRUE(map.is_of_another_building());
}

}  // namespace
}  // namespace waymark
