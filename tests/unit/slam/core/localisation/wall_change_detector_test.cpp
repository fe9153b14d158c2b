// SPDX-License-Identifier: BSD-3-Clause
#include "slam/core/localisation/wall_change_detector.hpp"

#include "slam/core/mapping/insert_scan.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <memory>
#include <numbers>
#include <vector>

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

// Parallel beams, one for each row of cells: every scan visits every cell once.

constexpr double kCell_m = 0.05;
constexpr int kRows = 12;
const double kNear_m = 20 * kCell_m;
const double kWall_m = 40 * kCell_m;
const double kFar_m = 60 * kCell_m;

/// @param away_m_of  distance of what is hit in a row.
template <class AwayOf>
Observation rows_of_beams(int rows, const AwayOf& away_m_of) {
  Observation observation;
  for (int row = 0; row < rows; ++row) {
    AnnotatedBeam annotated;
    annotated.beam.range_m = away_m_of(row);
    annotated.beam.start_in_base = {0.0, row * kCell_m};
    annotated.beam.end_in_base = {annotated.beam.range_m, row * kCell_m};
    observation.beams.push_back(annotated);
  }
  return observation;
}

Observation wall_across(int rows, double away_m) {
  return rows_of_beams(rows, [away_m](int) { return away_m; });
}

std::shared_ptr<const MapSnapshot> map_of(const Observation& observation,
                                          const Se2& map_from_base = {}) {
  auto map = std::make_shared<MapSnapshot>();
  map->grid.frame = GridFrame::centred_on_map_origin(kCell_m);
  for (int scan = 0; scan < 20; ++scan)
    insert_beams(observation.beams, map_from_base, map->grid);
  return map;
}

void add_scans(int scans, const Observation& observation, WallChangeDetector& detector,
               const Se2& map_from_base = {}) {
  for (int scan = 0; scan < scans; ++scan)
    detector.add(observation, map_from_base);
}

/// The changes after one more scan; before it there are none.
std::vector<MapChange> changes_by_one_more(const Observation& observation,
                                           WallChangeDetector& detector) {
  EXPECT_TRUE(detector.changes().empty());
  add_scans(1, observation, detector);
  return detector.changes();
}

/// One change, of the inner rows only: a changed cell needs free cells on all sides.
void expect_change_of_inner_rows(const std::vector<MapChange>& changes, MapChange::Kind kind,
                                 double away_m) {
  ASSERT_EQ(changes.size(), 1U);
  EXPECT_EQ(changes[0].kind, kind);
  EXPECT_EQ(changes[0].support, kRows - 2);
  EXPECT_NEAR(changes[0].size_m, (kRows - 2) * kCell_m, 1e-9);
  EXPECT_NEAR(changes[0].place.x(), away_m, 1e-9);
  EXPECT_NEAR(changes[0].place.y(), 0.5 * (kRows - 1) * kCell_m, 1e-9);
}

TEST(WallChangeDetector, AWallIsGoneOnceEightBeamsHavePassedThroughEveryCell) {
  WallChangeDetector detector{map_of(wall_across(kRows, kWall_m))};
  add_scans(7, wall_across(kRows, kFar_m), detector);
  expect_change_of_inner_rows(changes_by_one_more(wall_across(kRows, kFar_m), detector),
                              MapChange::Kind::kWallGone, kWall_m);
}

TEST(WallChangeDetector, AWallIsNewOnceEightBeamsHaveEndedInEveryCell) {
  WallChangeDetector detector{map_of(wall_across(kRows, kWall_m))};
  add_scans(7, wall_across(kRows, kNear_m), detector);
  expect_change_of_inner_rows(changes_by_one_more(wall_across(kRows, kNear_m), detector),
                              MapChange::Kind::kWallNew, kNear_m);
}

TEST(WallChangeDetector, AWallIsGoneOnceFewerThanATenthOfTheBeamsHitIt) {
  WallChangeDetector detector{map_of(wall_across(kRows, kWall_m))};
  add_scans(2, wall_across(kRows, kWall_m), detector);
  add_scans(18, wall_across(kRows, kFar_m), detector);
  EXPECT_EQ(changes_by_one_more(wall_across(kRows, kFar_m), detector).size(), 1U);
}

TEST(WallChangeDetector, AnObstacleIsANewWallOnceItStopsMoreThanHalfOfTheBeams) {
  WallChangeDetector detector{map_of(wall_across(kRows, kWall_m))};
  add_scans(10, wall_across(kRows, kNear_m), detector);
  add_scans(10, wall_across(kRows, kWall_m), detector);
  EXPECT_EQ(changes_by_one_more(wall_across(kRows, kNear_m), detector).size(), 1U);
}

TEST(WallChangeDetector, AWallSeenOneCellOffHasNotChangedAndTwoCellsOffHasChanged) {
  for (const int cells : {-2, -1, 1, 2}) {
    WallChangeDetector detector{map_of(wall_across(kRows, kWall_m))};
    add_scans(20, wall_across(kRows, kWall_m + cells * kCell_m), detector);
    EXPECT_EQ(detector.changes().size(), std::abs(cells) == 1 ? 0U : 1U) << cells;
  }
}

TEST(WallChangeDetector, FewerThanSixChangedCellsAreNoChange) {
  for (const int rows : {7, 8}) {
    WallChangeDetector detector{map_of(wall_across(rows, kWall_m))};
    add_scans(20, wall_across(rows, kFar_m), detector);
    EXPECT_EQ(detector.changes().size(), rows == 8 ? 1U : 0U) << rows;
  }
}

TEST(WallChangeDetector, ChangesAreOneClusterUpToAGapOfOneCell) {
  for (const int gap : {1, 2}) {
    const auto wall_with_a_gap = [gap](int row) {
      return row >= 10 && row < 10 + gap ? kFar_m : kWall_m;
    };
    for (const double heading_rad : {0.0, 0.5 * std::numbers::pi}) {  // walls along y, along x
      const Se2 pose{0.0, 0.0, heading_rad};
      WallChangeDetector detector{map_of(rows_of_beams(22, wall_with_a_gap), pose)};
      add_scans(20, wall_across(22, kFar_m), detector, pose);
      EXPECT_EQ(detector.changes().size(), gap == 1 ? 1U : 2U) << gap << ", " << heading_rad;
    }
  }
}

TEST(WallChangeDetector, ScansFromAnUnmappedPlaceAreIgnored) {
  WallChangeDetector detector{map_of(wall_across(kRows, kWall_m))};
  add_scans(20, wall_across(kRows, kFar_m), detector, {-1.0, 0.0, 0.0});
  EXPECT_TRUE(detector.changes().empty());
}

}  // namespace
}  // namespace waymark
