// SPDX-License-Identifier: BSD-3-Clause
// Laws of the whole waymark estimator over simulated drives and seeds.
#include "estimator_run.hpp"
#include "slam/core/estimators/waymark.hpp"
#include "slam/parallel.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace waymark {
namespace {

using test::estimator_setup_of;
using test::run;
using test::SensorLog;
using test::setup_of;
using test::Step;
using test::SyntheticCorridor;

constexpr Eigen::Index kFocalLength = kOdometryErrors + SightingSigmas::kFocal;

std::vector<Step> run_waymark(const SensorLog& log, const SyntheticCorridor& corridor,
                              std::uint64_t seed, const WaymarkConfig& config = {}) {
  WaymarkEstimator estimator{estimator_setup_of(corridor, seed), config};
  return run(estimator, log, setup_of(corridor));
}

/// In the middle of a corridor whose ends are out of sight.
SyntheticCorridor between_two_walls(std::uint64_t seed) {
  SyntheticCorridor corridor = test::short_corridor(seed);
  corridor.length_m = 40.0;
  corridor.start_x_m = 10.0;
  corridor.drive_m = 6.0;
  corridor.markers.clear();
  return corridor;
}

/// There, with wheels that are 3 % off.
SyntheticCorridor driven_on_wrong_wheels(std::uint64_t seed) {
  SyntheticCorridor corridor = between_two_walls(seed);
  corridor.scale_error = 0.03;
  corridor.drive_m = 12.0;
  return corridor;
}

double along_variance_m2(const Step& step) {
  return step.estimate.covariance(0, 0);
}

double along_error_m(const Step& step) {
  return step.estimate.map_from_base.x() - step.truth.x();
}

/// Along the corridor, as for on-line poses.
double along_rmse_m(const std::vector<TimedPose>& way, const std::vector<Step>& steps) {
  double sum = 0.0;
  for (std::size_t i = 0; i < way.size(); ++i)
    sum += std::pow(way[i].map_from_base.x() - steps[i].truth.x(), 2);
  return std::sqrt(sum / static_cast<double>(way.size()));
}

// With nothing ahead or behind that tells how far it went, and wheels that are 3 % off, the robot
// learns that from the markers it passes: too late for the poses so far. On single seeds chance may
// have it the other way round.
TEST(Waymark, TheWayIsKnownBetterAtTheEnd) {
  double on_line = 0.0;
  double smoothed = 0.0;
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    SyntheticCorridor corridor = driven_on_wrong_wheels(seed);
    corridor.markers = test::opposite_markers(corridor);
    WaymarkEstimator estimator{estimator_setup_of(corridor, seed), {}};
    const auto steps = run(estimator, test::drive(corridor), setup_of(corridor));
    const auto way = estimator.trajectory();
    ASSERT_EQ(way.size(), steps.size());
    EXPECT_NEAR(way.back().map_from_base.x(), steps.back().estimate.map_from_base.x(), 1e-3);
    on_line += std::pow(test::along_rmse_m(steps), 2);
    smoothed += std::pow(along_rmse_m(way, steps), 2);

    std::size_t cells = 0;
    std::size_t redrawn_cells = 0;
    const auto count = [](std::size_t& number) {
      return [&number](TileIndex, const auto&) {
        ++number;
      };
    };
    estimator.map().occupancy.for_each_tile(count(cells));
    estimator.redrawn_map().occupancy.for_each_tile(count(redrawn_cells));
    EXPECT_NEAR(static_cast<double>(redrawn_cells), static_cast<double>(cells), 2.0);
  }
  EXPECT_LT(smoothed, on_line);
}

TEST(Waymark, WithoutMarkersTheVarianceAlongACorridorNeverShrinks) {
  constexpr double kScatter = 0.05;
  for (std::uint64_t seed = 1; seed <= 2; ++seed) {
    SyntheticCorridor corridor = between_two_walls(seed);
    corridor.wander_rad = 0.0;  // driving to and fro between the walls tells the scale of distances
    const auto steps = run_waymark(test::drive(corridor), corridor, seed);
    double widest_m2 = 0.0;
    for (const Step& step : steps) {
      ASSERT_GE(along_variance_m2(step), (1.0 - kScatter) * widest_m2) << seed;
      widest_m2 = std::max(widest_m2, along_variance_m2(step));
    }
    const OdometryNoise noise;
    const double walk_m2 = std::pow(noise.along_per_sqrt_m, 2) * corridor.drive_m;
    const double scale_m2 = std::pow(noise.scale_sigma * corridor.drive_m, 2);
    EXPECT_NEAR(widest_m2, walk_m2 + scale_m2, 0.4 * (walk_m2 + scale_m2)) << seed;
    EXPECT_LT(std::pow(along_error_m(steps.back()), 2), 9.0 * widest_m2) << seed;
    EXPECT_EQ(steps.back().estimate.health, Health::kDegenerate) << seed;
    EXPECT_EQ(steps.back().estimate.weak_axis_source, WeakAxisSource::kOdometry) << seed;
  }
}

// Each scan's direction of the walls is off by its noise. What that lets through of the way along
// them would tell the scale of distances, falsely and better and better.
TEST(Waymark, ALongBareCorridorDoesNotTellTheScaleOfDistances) {
  SyntheticCorridor corridor = between_two_walls(1);
  corridor.length_m += 50.0;
  corridor.drive_m += 50.0;
  corridor.speed_m_s = 0.5;
  const auto steps = run_waymark(test::drive(corridor), corridor, 1);
  const double scale_m2 = std::pow(OdometryNoise{}.scale_sigma * corridor.drive_m, 2);
  EXPECT_GT(along_variance_m2(steps.back()), 0.3 * scale_m2);
}

// Markers follow the scale of distances, so that they do not tell it either: what one scan has left
// open must stay open while the robot moves on.
TEST(Waymark, ALongCorridorWithMarkersDoesNotTellTheScaleOfDistances) {
  SyntheticCorridor corridor = between_two_walls(3);
  corridor.length_m = 120.0;
  corridor.drive_m = 96.0;
  corridor.speed_m_s = 0.5;
  corridor.markers = test::opposite_markers(corridor, 13.0);
  WaymarkConfig config;
  config.particles = 10;
  WaymarkEstimator estimator{estimator_setup_of(corridor, 3), config};
  run(estimator, test::drive(corridor), setup_of(corridor));
  const double focal_variance = estimator.belief().errors_covariance()(kFocalLength, kFocalLength);
  EXPECT_GT(focal_variance, 0.5 * std::pow(SightingSigmas{}.learnt[SightingSigmas::kFocal], 2));
}

// Seen at the start, then hidden, then seen again.
TEST(Waymark, AKnownMarkerShrinksTheVarianceAlongTheCorridor) {
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    SyntheticCorridor corridor = between_two_walls(seed);
    corridor.drive_m = 3.0;
    corridor.markers = {{0, {15.0, 1.0}, radians(-90.0)}, {1, {15.0, -1.0}, radians(90.0)}};
    SensorLog log = test::drive(corridor);
    const Timestamp start = log.truth.front().time;
    const Timestamp hidden = start + duration_from_seconds(1.0 / corridor.speed_m_s);
    const Timestamp again = start + duration_from_seconds(2.0 / corridor.speed_m_s);
    for (MarkerDetections& frame : log.frames)
      if (frame.time > hidden && frame.time < again) frame.detections.clear();

    const auto steps = run_waymark(log, corridor, seed);
    double at_its_widest_m2 = 0.0;
    for (const Step& step : steps)
      if (step.estimate.time < again)
        at_its_widest_m2 = std::max(at_its_widest_m2, along_variance_m2(step));
    EXPECT_LT(along_variance_m2(steps.back()), 0.7 * at_its_widest_m2) << seed;
    EXPECT_EQ(steps.back().estimate.health, Health::kTracking) << seed;
    EXPECT_EQ(steps.back().estimate.weak_axis_source, WeakAxisSource::kMarkers) << seed;
  }
}

// For ablations: the pose is drawn whole, and markers only weigh the particles, by what is measured
// of them or by the ids in the map's cells.
TEST(Waymark, MarkersThatOnlyWeighHoldTheRobotToo) {
  WaymarkConfig by_measurement;
  by_measurement.markers_in_proposal = false;
  by_measurement.marker_evidence = 1.0;
  by_measurement.drawn_spread = 1.0;
  WaymarkConfig by_cells = by_measurement;
  by_cells.marker_evidence = 0.0;
  by_cells.id_layer_evidence = 1.0;
  double measured = 0.0;
  double in_cells = 0.0;
  double blind = 0.0;
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    SyntheticCorridor corridor = driven_on_wrong_wheels(seed);
    const auto square = [](double x) {
      return x * x;
    };
    blind += square(test::along_rmse_m(run_waymark(test::drive(corridor), corridor, seed)));
    corridor.markers = test::opposite_markers(corridor);
    const SensorLog log = test::drive(corridor);
    measured += square(test::along_rmse_m(run_waymark(log, corridor, seed, by_measurement)));
    in_cells += square(test::along_rmse_m(run_waymark(log, corridor, seed, by_cells)));
  }
  EXPECT_LT(std::sqrt(measured), 0.7 * std::sqrt(blind));
  EXPECT_LT(std::sqrt(in_cells), 0.7 * std::sqrt(blind));
}

TEST(Waymark, AMirroredWorldGivesAMirroredResult) {
  for (std::uint64_t seed = 1; seed <= 2; ++seed) {
    SyntheticCorridor corridor = test::short_corridor(seed);
    corridor.drive_m = 6.0;
    const SensorLog log = test::drive(corridor);
    const auto direct = run_waymark(log, corridor, 1);
    const auto mirrored = run_waymark(test::mirrored(log), corridor, 1);
    ASSERT_EQ(direct.size(), mirrored.size());
    // What particles draw is not mirrored, but their mean hardly depends on it: less than on what
    // the sensors leave open.
    for (std::size_t i = 0; i < direct.size(); ++i) {
      const Se2& a = direct[i].estimate.map_from_base;
      const Se2& b = mirrored[i].estimate.map_from_base;
      ASSERT_NEAR(a.x(), b.x(), 0.005) << seed << " " << i;
      ASSERT_NEAR(a.y(), -b.y(), 0.005) << seed << " " << i;
      ASSERT_NEAR(a.theta(), -b.theta(), radians(0.1)) << seed << " " << i;
    }
  }
}

bool are_equal(const Estimate& a, const Estimate& b) {
  return a.map_from_base.translation() == b.map_from_base.translation() &&
         a.map_from_base.theta() == b.map_from_base.theta() && a.covariance == b.covariance &&
         a.effective_particles == b.effective_particles && a.health == b.health;
}

TEST(Waymark, TheNumberOfThreadsDoesNotChangeABit) {
  SyntheticCorridor corridor = test::short_corridor(3);
  corridor.drive_m = 6.0;
  const SensorLog log = test::drive(corridor);
  EstimatorSetup setup = estimator_setup_of(corridor, 7);
  WaymarkEstimator alone{setup, {}};
  const auto expected = run(alone, log, setup_of(corridor));
  for (const int threads : {2, 3}) {
    setup.parallel_for = parallel_for_with(threads);
    WaymarkEstimator together{setup, {}};
    const auto steps = run(together, log, setup_of(corridor));
    ASSERT_EQ(steps.size(), expected.size());
    for (std::size_t i = 0; i < steps.size(); ++i)
      ASSERT_TRUE(are_equal(steps[i].estimate, expected[i].estimate)) << threads << " " << i;
    const auto one = alone.landmarks();
    const auto other = together.landmarks();
    ASSERT_EQ(one.size(), other.size());
    for (std::size_t i = 0; i < one.size(); ++i) {
      EXPECT_EQ(one[i].map_from_marker.translation(), other[i].map_from_marker.translation());
      EXPECT_EQ(one[i].covariance, other[i].covariance);
    }
  }
}

TEST(Waymark, AnotherSeedGivesAnotherResult) {
  SyntheticCorridor corridor = between_two_walls(3);
  corridor.drive_m = 1.0;
  const SensorLog log = test::drive(corridor);
  EXPECT_FALSE(are_equal(run_waymark(log, corridor, 7).back().estimate,
                         run_waymark(log, corridor, 8).back().estimate));
}

}  // namespace
}  // namespace waymark
