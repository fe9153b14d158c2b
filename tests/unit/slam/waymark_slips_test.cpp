// SPDX-License-Identifier: BSD-3-Clause
// What waymark does where the odometry is worse than it is said to be.
#include "common/random/random.hpp"
#include "property/slam/estimator_run.hpp"
#include "slam/core/belief/noise_growth.hpp"
#include "slam/core/belief/slip_watch.hpp"
#include "slam/core/estimators/waymark.hpp"
#include "support/room_with_column.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <optional>
#include <vector>

namespace waymark {
namespace {

using test::scan_of_room;

/// Drives a metre through the room, is pushed while the wheels say that it drives on, and goes on.
Se2 error_after_push(const Se2& push, std::uint64_t seed) {
  EstimatorSetup setup;
  setup.seed = seed;
  setup.range_sigma_m = 0.01;
  WaymarkEstimator estimator{setup, {}};
  Estimate estimate;
  const Motion step{Se2{0.12, 0.0, 0.01}, 0.12, 0.01};
  const Se2 driven =
      test::drive_through_room(step, 9, push, [&](const Observation& observation, bool is_pushed) {
        estimate = estimator.update(observation);
        EXPECT_EQ(estimate.slipped, is_pushed);
      });
  return driven.inverse() * estimate.map_from_base;
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

/// The odometry repeats itself on the way from `from_m` to `to_m`, and then goes on as it would
/// have.
void stick(test::SensorLog& log, double from_m, double to_m) {
  const double start_m = log.truth.front().world_from_base.x();
  std::optional<Se2> stuck;
  for (std::size_t i = 0; i < log.odometry.size(); ++i) {
    const double travel_m = log.truth[i].world_from_base.x() - start_m;
    if (travel_m < from_m || travel_m > to_m) continue;
    if (!stuck) stuck = log.odometry[i].odom_from_base;
    log.odometry[i].odom_from_base = *stuck;
  }
}

TEST(Waymark, CatchesUpWithAnOdometryThatWasStuck) {
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    test::SyntheticCorridor corridor;
    corridor.seed = seed;
    corridor.drive_m = 12.0;
    corridor.speed_m_s = 0.2;
    corridor.markers = test::opposite_markers(corridor);
    test::SensorLog log = test::drive(corridor);
    stick(log, 6.0, 8.0);
    SensorQueue queue{test::setup_of(corridor)};
    WaymarkEstimator estimator{test::estimator_setup_of(corridor, seed), {}};
    Estimate estimate;
    int caught_up = 0;
    test::feed(queue, log, [&](const SensorQueue::Ready& ready) {
      estimate = estimator.update(ready.observation);
      caught_up += ready.observation.odometry_caught_up;
    });
    EXPECT_EQ(caught_up, 1);
    EXPECT_EQ(queue.take_skips(), std::vector{Skip::kOdometryStuck});
    // Without it the robot is lost by the way that it drove out of sight of known markers.
    EXPECT_NEAR(estimate.map_from_base.x(), corridor.drive_m, 0.06) << seed;
  }
}

/// One wheel turns further than it rolls, by a share of its way from `from_m` to `to_m`.
/// @param track_m  positive where it is the left one.
void spin_wheel(test::SensorLog& log, double from_m, double to_m, double share, double track_m) {
  const double start_m = log.truth.front().world_from_base.x();
  Se2 before = log.odometry.front().odom_from_base;
  for (std::size_t i = 1; i < log.odometry.size(); ++i) {
    Se2& pose = log.odometry[i].odom_from_base;
    const Se2 step = before.inverse() * pose;
    before = pose;
    const double travel_m = log.truth[i].world_from_base.x() - start_m;
    const bool spins = travel_m > from_m && travel_m < to_m;
    const double more_m = spins ? share * step.x() : 0.0;
    pose = log.odometry[i - 1].odom_from_base *
           Se2{step.x() + 0.5 * more_m, step.y(), step.theta() - more_m / track_m};
  }
}

/// One wheel spins over 3 m of 12 m: the robot seems to turn by 60 degrees, and the way is told
/// half the track times that too long. Else the odometry is known well.
std::vector<test::Step> drive_on_a_spinning_wheel(test::SyntheticCorridor corridor,
                                                  double track_m) {
  corridor.drive_m = 12.0;
  corridor.speed_m_s = 0.2;
  corridor.scale_error = 0.0;
  corridor.length_m = 40.0;
  corridor.start_x_m = 10.0;  // its ends are out of sight
  test::SensorLog log = test::drive(corridor);
  spin_wheel(log, 6.0, 9.0, 0.35 * std::abs(track_m), track_m);
  WaymarkConfig config;
  config.odometry.scale_sigma = 0.001;
  EstimatorSetup setup = test::estimator_setup_of(corridor, corridor.seed);
  setup.half_track_m = 0.5 * std::abs(track_m);
  WaymarkEstimator estimator{setup, config};
  return test::run(estimator, log, test::setup_of(corridor));
}

double along_sigma_m(const test::Step& step) {
  return std::sqrt(step.estimate.covariance(0, 0));
}

// The walls show the turn. What the way is off by follows from it, but for the sign of skids.
TEST(Waymark, AWheelThatSlipsMakesItUnsureOfTheWay) {
  for (const double track_m : {0.287, -0.287, 0.6}) {
    const auto steps = drive_on_a_spinning_wheel({}, track_m);
    const double error_m = steps.back().estimate.map_from_base.x() - steps.back().truth.x();
    EXPECT_GT(error_m, 0.4 * std::abs(track_m));
    EXPECT_LT(error_m, 1.5 * along_sigma_m(steps.back()));
    int slips = 0;
    for (const test::Step& step : steps) {
      if (!step.estimate.slipped) continue;
      ++slips;
      EXPECT_NEAR(step.truth.x(), 7.5, 1.7);
    }
    EXPECT_GT(slips, 20);
    EXPECT_NEAR(steps.back().estimate.map_from_base.theta(), steps.back().truth.theta(), 0.01);
  }
}

TEST(Waymark, MarkersTellWhatASlipCosts) {
  for (const double track_m : {0.287, -0.287}) {
    test::SyntheticCorridor corridor;
    corridor.markers = test::opposite_markers(corridor, 12.0);
    double worst = 0.0;
    for (const test::Step& step : drive_on_a_spinning_wheel(corridor, track_m)) {
      const double error_m = std::abs(step.estimate.map_from_base.x() - step.truth.x());
      worst = std::max(worst, error_m);
      EXPECT_LT(error_m, 4.0 * along_sigma_m(step) + 0.002);
    }
    EXPECT_LT(worst, 0.04);
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

const Motion kStep{Se2{0.1, 0.0, 0.0}, 0.1, 0.0};

/// By walls, of the heading.
PoseCorrection turned_by(double turn_rad) {
  PoseCorrection correction;
  correction.by.z() = turn_rad;
  correction.posterior_variance.z() = 1e-6;
  return correction;
}

double sigma_of_step_rad() {
  return std::sqrt(turn_variance({}, kStep.distance_m, kStep.turn_rad));
}

/// Has seen a while of odometry whose turns are `times` as noisy as they are told to be.
SlipWatch used_to(double times) {
  SlipWatch watch;
  Random random{5};
  for (int i = 0; i < 500; ++i)
    watch.learn(turned_by(random.normal(0.0, times * sigma_of_step_rad())), kStep, {});
  return watch;
}

double slip_found_by(const SlipWatch& watch, double sigmas) {
  return watch.slipped_turn(turned_by(sigmas * sigma_of_step_rad()), kStep, {});
}

TEST(SlipWatch, FindsTurnsThatStandOutOfTheNoise) {
  EXPECT_EQ(slip_found_by({}, 4.0), 0.0);
  EXPECT_EQ(slip_found_by({}, -8.0), -8.0 * sigma_of_step_rad());
}

TEST(SlipWatch, IsUsedToAnOdometryThatIsWorseThanTold) {
  EXPECT_EQ(slip_found_by(used_to(0.3), 4.0), 0.0);
  EXPECT_NE(slip_found_by(used_to(0.3), 8.0), 0.0);
  EXPECT_EQ(slip_found_by(used_to(3.0), 10.0), 0.0);
  EXPECT_NE(slip_found_by(used_to(3.0), 24.0), 0.0);
}

// Neither where it begins, in the middle of an update, nor for as long as it lasts.
TEST(SlipWatch, DoesNotGetUsedToASlip) {
  SlipWatch watch = used_to(1.0);
  watch.learn(turned_by(4.5 * sigma_of_step_rad()), kStep, {});
  for (int i = 0; i < 200; ++i) {
    ASSERT_NE(slip_found_by(watch, 7.0), 0.0) << i;
    watch.learn(turned_by(7.0 * sigma_of_step_rad()), kStep, {});
  }
}

TEST(SlipWatch, LeavesTurnsOnTheSpotAlone) {
  const Motion on_the_spot{Se2{0.01, 0.0, 1.5}, 0.01, 1.5};
  EXPECT_EQ(SlipWatch{}.slipped_turn(turned_by(0.5), on_the_spot, {}), 0.0);
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
