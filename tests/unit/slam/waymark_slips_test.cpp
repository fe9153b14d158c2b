// SPDX-License-Identifier: BSD-3-Clause
// What waymark does where the odometry is worse than it is said to be.
#include "common/random/random.hpp"
#include "slam/core/belief/noise_growth.hpp"
#include "slam/core/estimators/waymark.hpp"
#include "slam/core/scan/turn_by_scans.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <numbers>
#include <vector>

namespace waymark {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;

/// Range from inside a room of 6 m x 4 m with a column, in the map frame.
double range_in_room(const Eigen::Vector2d& from, double direction_rad) {
  const Eigen::Vector2d ray{std::cos(direction_rad), std::sin(direction_rad)};
  double range_m = 100.0;
  if (ray.x() > 1e-9) range_m = std::min(range_m, (3.0 - from.x()) / ray.x());
  if (ray.x() < -1e-9) range_m = std::min(range_m, (-3.0 - from.x()) / ray.x());
  if (ray.y() > 1e-9) range_m = std::min(range_m, (2.0 - from.y()) / ray.y());
  if (ray.y() < -1e-9) range_m = std::min(range_m, (-2.0 - from.y()) / ray.y());
  const Eigen::Vector2d to_column = Eigen::Vector2d{1.5, 0.7} - from;
  const double ahead_m = ray.dot(to_column);
  const double beside_m = std::abs(ray.x() * to_column.y() - ray.y() * to_column.x());
  if (ahead_m > 0.0 && beside_m < 0.2)
    range_m = std::min(range_m, ahead_m - std::sqrt(0.04 - beside_m * beside_m));
  return range_m;
}

std::vector<AnnotatedBeam> scan_of_room(const Se2& map_from_base) {
  std::vector<AnnotatedBeam> beams;
  Random random{3};
  for (int i = 0; i < 360; ++i) {
    const double bearing_rad = i * kDegree;
    AnnotatedBeam annotated;
    annotated.beam.range_m =
        range_in_room(map_from_base.translation(), map_from_base.theta() + bearing_rad) +
        0.01 * random.normal();
    annotated.beam.end_in_base =
        annotated.beam.range_m * Eigen::Vector2d{std::cos(bearing_rad), std::sin(bearing_rad)};
    beams.push_back(annotated);
  }
  return beams;
}

TEST(TurnBetween, FindsTheTurnThatTheWheelsDidNotMake) {
  for (const double slip_deg : {-40.0, -12.0, 8.0, 35.0}) {
    const Se2 start{-0.5, 0.3, 0.2};
    const Motion told{Se2{0.1, 0.0, 0.05}, 0.1, 0.05};
    const Se2 end{Eigen::Vector2d{(start * told.start_from_end).translation()},
                  start.theta() + 0.05 + slip_deg * kDegree};
    const auto found = turn_between(scan_of_room(start), scan_of_room(end), told);
    ASSERT_TRUE(found) << slip_deg;
    EXPECT_TRUE(found->contradicts_odometry) << slip_deg;
    EXPECT_NEAR(found->turn_rad, 0.05 + slip_deg * kDegree, 1.6 * kDegree) << slip_deg;
  }
}

TEST(TurnBetween, BelievesGoodOdometry) {
  for (const double turn_deg : {-30.0, 0.0, 1.0, 20.0}) {
    const Se2 start{0.4, -0.3, 1.0};
    const Motion told{Se2{0.1, 0.0, turn_deg * kDegree}, 0.1, std::abs(turn_deg) * kDegree};
    const auto found =
        turn_between(scan_of_room(start), scan_of_room(start * told.start_from_end), told);
    ASSERT_TRUE(found) << turn_deg;
    EXPECT_FALSE(found->contradicts_odometry) << turn_deg;
  }
}

TEST(TurnBetween, HasNothingToSayWithoutScans) {
  EXPECT_FALSE(turn_between({}, scan_of_room({}), {}));
  EXPECT_FALSE(turn_between(scan_of_room({}), {}, {}));
}

/// Drives a metre through the room, is pushed while the wheels say that it drives on, and goes on.
Se2 error_after_push(const Se2& push, std::uint64_t seed) {
  EstimatorSetup setup;
  setup.seed = seed;
  setup.range_sigma_m = 0.01;
  WaymarkEstimator estimator{setup, {}};
  const Se2 start{-1.5, -0.6, 0.3};
  const Motion step{Se2{0.12, 0.0, 0.01}, 0.12, 0.01};
  Se2 truth = start;
  Observation observation;
  Estimate estimate;
  for (int i = 0; i < 12; ++i) {
    if (i > 0) {
      observation.motion = step;
      truth = truth * (i == 9 ? push : step.start_from_end);
    }
    observation.time += std::chrono::milliseconds{200};
    observation.beams = scan_of_room(truth);
    estimate = estimator.update(observation);
    EXPECT_EQ(estimate.slipped, i == 9) << i;
  }
  return (start.inverse() * truth).inverse() * estimate.map_from_base;
}

TEST(Waymark, FindsItsWallsAgainAfterAPush) {
  for (const Se2& push : {Se2{-0.1, 0.0, 0.12}, Se2{0.1, 0.18, -0.1}, Se2{0.1, -0.18, -0.15},
                          Se2{0.12, 0.0, 0.6}}) {  // the last one: turned by hand
    for (std::uint64_t seed = 1; seed <= 3; ++seed) {
      const Se2 error = error_after_push(push, seed);
      EXPECT_LT(error.translation().norm(), 0.02) << push.x() << ' ' << push.y();
      EXPECT_LT(std::abs(error.theta()), 0.01) << push.x() << ' ' << push.y();
    }
  }
}

// Each sighting is at odds with the map and is looked at at once, though the robot has not moved
// and nothing of its pose is open any more.
TEST(Waymark, StandsStillBeforeAMarkerThatJumpsAbout) {
  EstimatorSetup setup;
  setup.range_sigma_m = 0.01;
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    setup.seed = seed;
    WaymarkConfig config;
    config.markers_in_proposal = seed % 2 == 0;
    WaymarkEstimator estimator{setup, config};
    Random random{seed};
    Observation observation;
    observation.beams = scan_of_room({-1.5, -0.6, 0.3});
    MarkerSighting sighting;
    sighting.covariance_in_base = 1e-4 * Eigen::Matrix3d::Identity();
    sighting.size_m = 0.4;
    for (int i = 0; i < 100; ++i) {
      sighting.base_from_marker = {random.uniform(1.0, 2.0), random.uniform(-0.5, 0.5),
                                   random.uniform(2.5, 3.5)};
      sighting.id = static_cast<int>(random.uniform(0.0, 3.0));
      observation.sightings = {sighting};
      observation.time += std::chrono::milliseconds{200};
      const Estimate estimate = estimator.update(observation);
      ASSERT_LT(estimate.map_from_base.translation().norm(), 0.01) << seed << ' ' << i;
      ASSERT_TRUE(estimate.covariance.allFinite()) << seed << ' ' << i;
    }
  }
}

/// Corrections of a walk whose variance is `factor` times the one it is said to have.
Eigen::Vector3d learnt_from(double factor, int updates) {
  NoiseGrowth growth;
  Random random{11};
  for (int i = 0; i < updates; ++i) {
    const Eigen::Vector3d said = 1e-4 * growth.factors();
    PoseCorrection correction;
    correction.prior_variance = said;
    for (int axis = 0; axis < 3; ++axis)
      correction.by[axis] = std::sqrt(factor * 1e-4) * random.normal();
    growth.learn(correction);
  }
  return growth.factors();
}

TEST(NoiseGrowth, LearnsHowMuchTheWheelsSlip) {
  for (const double factor : {30.0, 300.0}) {
    const Eigen::Vector3d factors = learnt_from(factor, 400);
    EXPECT_GT(factors.minCoeff(), 0.3 * factor);
    EXPECT_LT(factors.maxCoeff(), 2.0 * factor);
  }
}

TEST(NoiseGrowth, IsOneWhereTheConfigurationIsRightOrTooWide) {
  EXPECT_LT(learnt_from(1.0, 400).maxCoeff(), 2.0);
  EXPECT_EQ(learnt_from(0.1, 400), Eigen::Vector3d::Ones());
}

TEST(NoiseGrowth, LeavesAxesAloneThatNothingWasToldAbout) {
  NoiseGrowth growth;
  PoseCorrection correction;
  correction.by = {0.5, 0.5, 0.5};
  correction.prior_variance = {1e-4, 1e-4, 1e-4};
  correction.posterior_variance = {0.99e-4, 0.0, 1e-4};
  growth.learn(correction);
  EXPECT_EQ(growth.factors()[0], 1.0);
  EXPECT_GT(growth.factors()[1], 1.0);
  EXPECT_EQ(growth.factors()[2], 1.0);
  const OdometryNoise grown = growth.applied_to({});
  EXPECT_EQ(grown.along_per_sqrt_m, OdometryNoise{}.along_per_sqrt_m);
  EXPECT_GT(grown.across_per_sqrt_m, OdometryNoise{}.across_per_sqrt_m);
}

}  // namespace
}  // namespace waymark
