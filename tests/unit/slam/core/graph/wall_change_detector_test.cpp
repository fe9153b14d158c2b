// SPDX-License-Identifier: BSD-3-Clause
#include "slam/core/graph/wall_change_detector.hpp"

#include "slam/core/mapping/insert_scan.hpp"

#include <gtest/gtest.h>

#include <memory>

namespace waymark {
namespace {

/// From the origin to a wall across the view, 1 m long.
Observation view_of_wall_at(double away_m) {
  Observation observation;
  for (int i = -25; i <= 25; ++i) {
    AnnotatedBeam annotated;
    annotated.beam.end_in_base = {away_m, 0.02 * i * away_m / 2.0};
    annotated.beam.range_m = annotated.beam.end_in_base.norm();
    observation.beams.push_back(annotated);
  }
  return observation;
}

std::shared_ptr<const MapSnapshot> map_with_wall_at(double away_m) {
  auto map = std::make_shared<MapSnapshot>();
  map->grid.frame = GridFrame::centred_on_map_origin(0.05);
  for (int scan = 0; scan < 20; ++scan)
    insert_beams(view_of_wall_at(away_m).beams, {}, map->grid);
  return map;
}

bool names_a_wall_that_is_gone(const WallChangeDetector& detector) {
  for (const MapChange& change : detector.changes())
    if (change.kind == MapChange::Kind::kWallGone) return true;
  return false;
}

TEST(WallChangeDetector, AWallThatIsRemovedAfterHoursIsDetectedWithinMinutes) {
  constexpr double kWall_m = 2.0;
  constexpr double kBehind_m = 3.0;
  WallChangeDetector detector{map_with_wall_at(kWall_m)};
  for (int scan = 0; scan < 20'000; ++scan)
    detector.add(view_of_wall_at(kWall_m), {});
  EXPECT_FALSE(names_a_wall_that_is_gone(detector));
  for (int scan = 0; scan < 1'000; ++scan)
    detector.add(view_of_wall_at(kBehind_m), {});
  EXPECT_TRUE(names_a_wall_that_is_gone(detector));
}

}  // namespace
}  // namespace waymark
