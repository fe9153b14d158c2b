// SPDX-License-Identifier: BSD-3-Clause
// Unit tests of what corrects the past.
#include "slam/core/smoothing/hindsight.hpp"
#include "slam/core/smoothing/scan_archive.hpp"
#include "slam/map_publisher.hpp"
#include "support/observations.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace waymark {
namespace {

constexpr double kSameMarker_m = 0.5;
constexpr double kFloat = 1e-5;  // gains are kept in single precision

Timestamp at_s(int seconds) {
  return Timestamp{std::chrono::seconds{seconds}};
}

MarkerMeasurement seen_at(const Se2& base_from_marker) {
  MarkerMeasurement measurement;
  measurement.id = 5;
  measurement.base_from_marker = base_from_marker;
  measurement.covariance = 1e-6 * Eigen::Matrix3d::Identity();
  return measurement;
}

Statics statics_of(const Belief& belief) {
  return {belief.static_errors(), belief.markers()};
}

// A scale that turns out to be larger by 1 % moves each pose by 1 % of its way.
TEST(Hindsight, AScaleLearntLaterStretchesTheWay) {
  Belief belief{{OdometryNoise{}, {0.005, 0.002, 0.003}}};
  Hindsight hindsight;
  for (int metre = 0; metre <= 10; ++metre) {
    if (metre > 0) belief.move({Se2{1.0, 0.0, 0.0}, 1.0, 0.0}, {});
    hindsight.add_update(belief.pose_by_statics(4), statics_of(belief));
    hindsight.add_scan(at_s(metre), belief.map_from_base());
  }
  Statics later = statics_of(belief);
  later.errors[0] += 0.01;
  const auto way = hindsight.way(later, kSameMarker_m);
  ASSERT_EQ(way.size(), 11U);
  for (std::size_t metre = 0; metre < way.size(); ++metre) {
    EXPECT_NEAR(way[metre].map_from_base.x(), 1.01 * static_cast<double>(metre), kFloat) << metre;
    EXPECT_NEAR(way[metre].map_from_base.y(), 0.0, kFloat) << metre;
  }
}

TEST(Hindsight, AMarkerCorrectedLaterTakesThePosesThatSawItAlong) {
  Belief belief{{OdometryNoise{}, Eigen::Vector3d::Zero()}};
  belief.move({Se2{5.0, 0.0, 0.0}, 5.0, 0.0}, {});
  belief.add(seen_at({2.0, 1.0, radians(-90.0)}));
  Hindsight hindsight;
  hindsight.add_update(belief.pose_by_statics(4), statics_of(belief));
  hindsight.add_scan(at_s(0), belief.map_from_base());
  Statics later = statics_of(belief);
  later.markers[0].map_from_marker = deviated(later.markers[0].map_from_marker, {0.1, 0.0, 0.0});
  EXPECT_NEAR(hindsight.way(later, kSameMarker_m)[0].map_from_base.x(), 5.1, 0.01);

  later.markers[0].map_from_marker = deviated(later.markers[0].map_from_marker, {0.9, 0.0, 0.0});
  EXPECT_NEAR(hindsight.way(later, kSameMarker_m)[0].map_from_base.x(), 5.0, kFloat)
      << "it was moved, not corrected";
  later.markers.clear();
  EXPECT_NEAR(hindsight.way(later, kSameMarker_m)[0].map_from_base.x(), 5.0, kFloat);
}

TEST(Hindsight, CorrectionsGrowEvenlyBetweenUpdatesAndStayBehindTheLast) {
  Belief belief{{OdometryNoise{}, Eigen::Vector3d::Zero()}};
  Hindsight hindsight;
  for (int second = 0; second <= 6; ++second) {
    if (second > 0) belief.move({Se2{1.0, 0.0, 0.0}, 1.0, 0.0}, {});
    if (second % 4 == 0) hindsight.add_update(belief.pose_by_statics(4), statics_of(belief));
    hindsight.add_scan(at_s(second), belief.map_from_base());
  }
  Statics later = statics_of(belief);
  later.errors[0] += 0.01;
  const auto way = hindsight.way(later, kSameMarker_m);
  EXPECT_NEAR(way[1].map_from_base.x(), 1.01, kFloat);
  EXPECT_NEAR(way[3].map_from_base.x(), 3.03, kFloat);
  EXPECT_NEAR(way[4].map_from_base.x(), 4.04, kFloat);
  EXPECT_NEAR(way[6].map_from_base.x(), 6.04, kFloat);
  EXPECT_EQ(hindsight.way_of_updates(later, kSameMarker_m).size(), 2U);
}

TEST(ScanArchive, GivesBackWhereBeamsWent) {
  const test::SyntheticCorridor corridor = test::bare_corridor();
  const Observation scan = test::observations_of(test::drive(corridor), corridor).front();
  ScanArchive archive;
  archive.add(scan, Se2{});
  const Observation again = archive.at(0);
  ASSERT_EQ(again.beams.size(), scan.beams.size());
  for (std::size_t i = 0; i < scan.beams.size(); ++i) {
    EXPECT_NEAR(again.beams[i].beam.range_m, scan.beams[i].beam.range_m, 1e-6);
    EXPECT_LT((again.beams[i].beam.end_in_base - scan.beams[i].beam.end_in_base).norm(), 1e-6);
  }
}

TEST(ScanArchive, KeepsTheNewestScansOfAPlace) {
  const test::SyntheticCorridor corridor = test::bare_corridor();
  const Observation scan = test::observations_of(test::drive(corridor), corridor).front();
  ScanArchive archive;
  archive.add(scan, Se2{5.0, 0.1, 0.1});
  for (std::size_t i = 0; i < 3 * ScanArchive::kScansPerPlace; ++i)
    archive.add(scan, Se2{1.1, 0.1, 0.1});
  EXPECT_FALSE(archive.at(0).beams.empty());
  for (std::size_t i = 1; i < archive.size(); ++i) {
    EXPECT_EQ(archive.at(i).beams.empty(), i + ScanArchive::kScansPerPlace < archive.size()) << i;
  }
}

TEST(MapPublisher, TilesThatAreGoneAreSentEmpty) {
  GridMap map{GridFrame::centred_on_map_origin(0.05), {}, {}};
  map.occupancy.edit(map.frame.cell_of(Eigen::Vector2d{0.0, 0.0})) = {1, 1};
  MapPublisher publisher;
  ASSERT_EQ(publisher.complete(map, at_s(0))[0].num_tiles, 1);
  GridMap elsewhere{map.frame, {}, {}};
  elsewhere.occupancy.edit(map.frame.cell_of(Eigen::Vector2d{20.0, 0.0})) = {1, 1};
  const auto parts = publisher.complete(elsewhere, at_s(1));
  ASSERT_EQ(parts[0].num_tiles, 2);
  int emptied = 0;
  for (const map_tile_t& tile : parts[0].tiles) {
    emptied += std::all_of(tile.occupancy.begin(), tile.occupancy.end(),
                           [](std::int8_t percent) { return percent == -1; });
  }
  EXPECT_EQ(emptied, 1);
}

}  // namespace
}  // namespace waymark
