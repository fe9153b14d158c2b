// SPDX-License-Identifier: BSD-3-Clause
#include "evaluate/map/marker_error.hpp"

#include "unit/tools/temporary_folder.hpp"

#include <gtest/gtest.h>

namespace waymark::evaluate {
namespace {

constexpr double kExact = 1e-9;
constexpr double kGate_m = 5.0;

TEST(MarkerError, IsMeasuredInTheWorld) {
  const Se2 world_from_map{1, 0, radians(90)};
  const std::vector<Marker> world{{7, Se2{1, 4, 0}}, {0, Se2{0, 4, radians(179)}}};
  // Marker 7 should be at (4, 0) in the map, and is 0.3 m and 2 deg off. Marker 0 is 0.1 m off; its
  // yaw is -179 deg in the world.
  const std::vector<Marker> map{{7, Se2{4.3, 0, radians(-88)}}, {0, Se2{4, 0.9, radians(91)}}};

  const MarkerError error = marker_error(map, world, world_from_map, kGate_m);

  EXPECT_EQ(error.matched, 2u);
  EXPECT_EQ(error.missing, 0u);
  EXPECT_EQ(error.spurious, 0u);
  EXPECT_NEAR(*error.mean_position_m, 0.2, kExact);
  EXPECT_NEAR(*error.max_position_m, 0.3, kExact);
  EXPECT_NEAR(*error.mean_yaw_deg, 2.0, kExact);
  EXPECT_NEAR(*error.max_yaw_deg, 2.0, kExact);
}

TEST(MarkerError, MarkersOfOneIdAreMatchedByTheirPlaces) {
  const std::vector<Marker> world{{5, Se2{4, 0, 0}}, {5, Se2{8, 0, 0}}};
  // The first estimate is within the gate of both; the second is nearer to the second place.
  const std::vector<Marker> map{{5, Se2{5, 0, 0}}, {5, Se2{8.2, 0, 0}}};
  const MarkerError error = marker_error(map, world, Se2{}, kGate_m);
  EXPECT_EQ(error.matched, 2u);
  EXPECT_NEAR(*error.mean_position_m, 0.6, kExact);
}

TEST(MarkerError, MissingAndSpuriousAreCounted) {
  const std::vector<Marker> world{{1, Se2{0, 0, 0}}, {2, Se2{1, 0, 0}}, {3, Se2{2, 0, 0}}};
  // Marker 1 is there twice, 2 is too far away, 9 does not exist, 3 is not seen.
  const std::vector<Marker> map{
      {1, Se2{0, 0, 0}}, {1, Se2{0.1, 0, 0}}, {2, Se2{7, 0, 0}}, {9, Se2{2, 0, 0}}};
  const MarkerError error = marker_error(map, world, Se2{}, kGate_m);
  EXPECT_EQ(error.matched, 1u);
  EXPECT_EQ(error.missing, 2u);
  EXPECT_EQ(error.spurious, 3u);
  EXPECT_NEAR(*error.max_position_m, 0.0, kExact);
}

TEST(MarkerError, MovedMarkersAreScoredAtTheirFinalPlace) {
  const TemporaryFolder folder;
  folder.file("truth.csv", "id,instance,x_m,y_m,yaw_rad\n5,0,4,0,0\n5,1,8,0,0\n6,0,9,0,0\n");
  folder.file("moves.csv", "t_s,id,instance,x_m,y_m,yaw_rad\n7,5,1,8.5,0,0\n9,5,1,9,0,0\n");
  SkippedLines skipped;
  const auto world = with_moves(read_markers(folder.path() / "truth.csv", skipped),
                                folder.path() / "moves.csv", skipped);
  ASSERT_EQ(world.size(), 3u);
  EXPECT_EQ(world[0].parent_from_marker.x(), 4.0);
  EXPECT_EQ(world[1].parent_from_marker.x(), 9.0);
  EXPECT_TRUE(world[1].has_moved && !world[0].has_moved);
  EXPECT_TRUE(skipped.empty());

  folder.file("map.csv", "id,instance,x_m,y_m,yaw_rad,state\n5,1,9,0,0,3\n6,0,9,0,0,1\n");
  const auto map = read_markers(folder.path() / "map.csv", skipped);
  const MarkerError error = marker_error(map, world, Se2{}, kGate_m);
  EXPECT_NEAR(*error.max_position_m, 0.0, kExact);
  EXPECT_EQ(error.moved_named_share, 1.0);
}

TEST(MarkerError, UnreportedMovesAndFalseReportsLowerTheNamedShare) {
  const Marker moved{.id = 1, .has_moved = true};
  const Marker still{.id = 2};
  EXPECT_EQ(marker_error({{1, Se2{}}}, {moved, still}, Se2{}, kGate_m).moved_named_share, 0.0);
  const Marker wrongly{.id = 2, .has_moved = true};
  EXPECT_EQ(marker_error({moved, wrongly}, {moved, still}, Se2{}, kGate_m).moved_named_share, 0.5);
  EXPECT_FALSE(marker_error({still}, {still}, Se2{}, kGate_m).moved_named_share);
}

TEST(MarkerError, TentativeMarkersAreIgnored) {
  const Marker tentative{.id = 1, .is_tentative = true};
  const MarkerError error = marker_error({tentative, {2, Se2{}}}, {{2, Se2{}}}, Se2{}, kGate_m);
  EXPECT_EQ(error.tentative, 1u);
  EXPECT_EQ(error.spurious, 0u);
  EXPECT_EQ(error.right_share, 1.0);
  EXPECT_EQ(marker_error({tentative}, {{1, Se2{}}}, Se2{}, kGate_m).missing, 1u);
}

TEST(MarkerError, WithoutMatchesThereIsNoMean) {
  const MarkerError error = marker_error({}, {{1, Se2{}}}, Se2{}, kGate_m);
  EXPECT_EQ(error.missing, 1u);
  EXPECT_FALSE(error.mean_position_m);
}

}  // namespace
}  // namespace waymark::evaluate
