// SPDX-License-Identifier: BSD-3-Clause
#include "slam/core/estimators/gmapping.hpp"
#include "support/observations.hpp"
#include "support/room_with_column.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <thread>

namespace waymark {
namespace {

using test::bare_corridor;
using test::drive;
using test::observations_of;
using test::SyntheticCorridor;

EstimatorSetup setup_for(const SyntheticCorridor& corridor) {
  EstimatorSetup setup;
  setup.range_max_m = corridor.range_max_m;
  return setup;
}

std::vector<Beam> noisy_beams_at(double x_m, const SyntheticCorridor& corridor, Random& random) {
  const LidarScan scan = test::scan_from(corridor, {x_m, 0.0, 0.0}, Timestamp{});
  std::vector<Beam> beams;
  for (std::size_t i = 0; i < scan.ranges_m.size(); ++i) {
    const double range_m = scan.ranges_m[i] + random.normal(0.0, corridor.range_sigma_m);
    if (!(range_m <= corridor.range_max_m)) continue;
    const double angle_rad = scan.angles_rad[i];
    beams.push_back({static_cast<int>(i), Eigen::Vector2d::Zero(),
                     range_m * Eigen::Vector2d{std::cos(angle_rad), std::sin(angle_rad)}, range_m});
  }
  return beams;
}

TEST(GmappingInABareCorridor, AScanMovedBackScoresMoreThoughOdometryIsPerfect) {
  // The reason of the collapse: beams that end beyond the mapped walls score nothing where they
  // belong, and something when the scan is moved back to where there are walls already.
  SyntheticCorridor corridor = bare_corridor();
  corridor.range_max_m = 3.0;  // the turtlebot3 preset's usable range: its hits leave no gaps
  constexpr double kStep_m = 0.06;
  const GridFrame frame = GridFrame::centred_on_map_origin(0.05);
  const MatcherSetting setting{MatcherConfig{}, frame};
  // Further back the score stays: by then all hits lie beside mapped ones.
  const std::vector<double> moved_back_m{-0.05, 0.0, 0.05};
  std::vector<double> scores(moved_back_m.size());
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    Random random{seed};
    HitMap map;
    double x_m = 8.0;
    for (; x_m < 10.0; x_m += kStep_m) {
      for (const Beam& beam : noisy_beams_at(x_m, corridor, random))
        add_hit(frame, Se2{x_m, 0.0, 0.0} * beam.end_in_base, map);
    }
    const std::vector<Beam> beams = noisy_beams_at(x_m, corridor, random);
    ScanMatcher matcher{setting, map, beams};
    for (std::size_t i = 0; i < scores.size(); ++i)
      scores[i] += matcher.score({x_m - moved_back_m[i], 0.0, 0.0});
  }
  EXPECT_THAT(scores, ::testing::WhenSorted(::testing::ElementsAreArray(scores)));
}

TEST(GmappingInABareCorridor, WatchingTurnsChangesNothingWhileOdometryTurnsAreRight) {
  SyntheticCorridor corridor;
  corridor.drive_m = 10.0;
  corridor.turn_noise_per_sqrt_m = 0.0175;
  GmappingConfig as_released;
  as_released.watch_turns = false;
  as_released.particles = 5;
  GmappingConfig watching = as_released;
  watching.watch_turns = true;
  GmappingEstimator released{setup_for(corridor), as_released};
  GmappingEstimator ours{setup_for(corridor), watching};
  for (const Observation& observation : observations_of(drive(corridor), corridor)) {
    const Se2 expected = released.update(observation).map_from_base;
    const Se2 found = ours.update(observation).map_from_base;
    ASSERT_EQ(found.translation(), expected.translation());
    ASSERT_EQ(found.theta(), expected.theta());
  }
}

/// A room of 6 m by 4 m that the LiDAR sees whole, with odometry that is 5 % too long.
SyntheticCorridor room() {
  SyntheticCorridor corridor;
  corridor.length_m = 6.0;
  corridor.width_m = 4.0;
  corridor.drive_m = 4.0;
  corridor.speed_m_s = 0.5;
  corridor.range_max_m = 12.0;
  corridor.scale_error = 0.05;
  corridor.seed = 3;
  return corridor;
}

TEST(GmappingEstimator, CorrectsOdometryInARoom) {
  const SyntheticCorridor corridor = room();
  const auto log = drive(corridor);
  GmappingConfig config;
  config.gate.linear_update_m = 0.2;
  GmappingEstimator estimator{setup_for(corridor), config};
  Estimate estimate;
  for (const Observation& observation : observations_of(log, corridor))
    estimate = estimator.update(observation);
  const Se2 truth = log.truth.front().world_from_base.inverse() * log.truth.back().world_from_base;
  const double odometry_error_m =
      (log.odometry.back().odom_from_base.translation() - truth.translation()).norm();
  EXPECT_GT(odometry_error_m, 0.15);
  EXPECT_LT((estimate.map_from_base.translation() - truth.translation()).norm(), 0.04);
  EXPECT_EQ(estimate.health, Health::kTracking);
  EXPECT_EQ(estimate.num_particles, 30U);
}

/// Heading error one step after the wheels have missed 0.45 rad, before the next match is due.
double heading_error_after_slip(bool watch_turns, std::uint64_t seed) {
  EstimatorSetup setup;
  setup.seed = seed;
  setup.range_max_m = 12.0;
  GmappingConfig config;
  config.watch_turns = watch_turns;
  GmappingEstimator estimator{setup, config};
  const Motion step{Se2{0.12, 0.0, 0.0}, 0.12, 0.0};
  Estimate estimate;
  const Se2 driven = test::drive_through_room(
      step, 10, Se2{0.12, 0.0, 0.45}, [&](const Observation& observation, bool has_slipped) {
        estimate = estimator.update(observation);
        EXPECT_EQ(estimate.odometry_refused, watch_turns && has_slipped);
      });
  return std::abs(angle_difference(estimate.map_from_base.theta(), driven.theta()));
}

TEST(GmappingEstimator, AfterAWheelSlipTheHeadingFollowsTheScansIfTurnsAreWatched) {
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    EXPECT_LT(heading_error_after_slip(true, seed), 0.03);
    EXPECT_GT(heading_error_after_slip(false, seed), 0.4);  // the released code
  }
}

TEST(GmappingEstimator, FollowsOdometryBetweenUpdates) {
  const SyntheticCorridor corridor = room();
  const auto observations = observations_of(drive(corridor), corridor);
  GmappingConfig config;  // gate of 1 m: an update every tenth scan
  GmappingEstimator estimator{setup_for(corridor), config};
  Se2 before = estimator.update(observations[0]).map_from_base;
  EXPECT_EQ(before.translation().norm(), 0.0);
  int corrections = 0;
  for (std::size_t i = 1; i < observations.size(); ++i) {
    const Se2 now = estimator.update(observations[i]).map_from_base;
    const Se2 followed = before * observations[i].motion.start_from_end;
    if ((now.translation() - followed.translation()).norm() > 1e-9) ++corrections;
    before = now;
  }
  EXPECT_EQ(corrections, 4);  // 4.2 m of odometry
}

/// As in the released code, which asks for odometry at scans only.
TEST(GmappingEstimator, JitterOfOdometryBetweenScansOpensNoGate) {
  SyntheticCorridor corridor = bare_corridor();
  corridor.drive_m = 0.5;
  const std::vector<Observation> scans = observations_of(drive(corridor), corridor);
  GmappingEstimator estimator{setup_for(corridor), {}};
  int updates = 0;
  for (Observation scan : scans) {
    scan.motion.distance_m += 1.0;
    scan.motion.turn_rad += 1.0;
    updates += estimator.update(scan).updated;
  }
  EXPECT_EQ(updates, 1);
}

TEST(GmappingEstimator, AnUnreachableMinimumScoreFollowsOdometryAndIsLost) {
  const SyntheticCorridor corridor = room();
  GmappingConfig config;
  config.minimum_score = 1000.0;
  config.motion = {0.0, 0.0, 0.0, 0.0};
  GmappingEstimator estimator{setup_for(corridor), config};
  Estimate estimate;
  Se2 odometry;
  for (const Observation& observation : observations_of(drive(corridor), corridor)) {
    odometry = odometry * observation.motion.start_from_end;
    estimate = estimator.update(observation);
  }
  EXPECT_LT((estimate.map_from_base.translation() - odometry.translation()).norm(), 1e-9);
  EXPECT_EQ(estimate.health, Health::kLost);
}

TEST(GmappingEstimator, ResultsDoNotDependOnThreads) {
  const SyntheticCorridor corridor = room();
  const auto observations = observations_of(drive(corridor), corridor);
  GmappingConfig config;
  config.particles = 8;
  config.gate.linear_update_m = 0.3;
  config.resample_threshold = 1.0;  // resamples all the time
  const EstimatorSetup serial = setup_for(corridor);
  EstimatorSetup parallel = serial;
  parallel.parallel_for = [](std::size_t count, const std::function<void(std::size_t)>& body) {
    std::vector<std::jthread> threads;
    for (std::size_t i = 0; i < count; ++i)
      threads.emplace_back([&body, i] { body(i); });
  };
  GmappingEstimator one{serial, config};
  GmappingEstimator many{parallel, config};
  for (const Observation& observation : observations) {
    const Estimate a = one.update(observation);
    const Estimate b = many.update(observation);
    ASSERT_EQ(a.map_from_base.translation(), b.map_from_base.translation());
    ASSERT_EQ(a.map_from_base.theta(), b.map_from_base.theta());
    ASSERT_EQ(a.effective_particles, b.effective_particles);
  }
  std::size_t cells = 0;
  one.map().occupancy.for_each_tile([&](TileIndex tile, const auto& of_one) {
    const auto* of_many = many.map().occupancy.tile(tile);
    ASSERT_TRUE(of_many);
    EXPECT_EQ(of_one, *of_many);
    cells += of_one.size();
  });
  EXPECT_GT(cells, 0U);
}

// Oracle: the poses of the best particle and of its ancestors, from parent to parent as published.
TEST(GmappingEstimator, TheTrajectoryFollowsTheAncestorsOfTheBestParticle) {
  const SyntheticCorridor corridor = room();
  const auto observations = observations_of(drive(corridor), corridor);
  for (const double resample_threshold : {0.0, 0.99}) {
    GmappingConfig config;
    config.particles = 8;
    config.gate.linear_update_m = 0.3;
    config.resample_threshold = resample_threshold;
    GmappingEstimator estimator{setup_for(corridor), config};
    std::vector<std::vector<PublishedParticle>> generations;
    std::vector<Timestamp> updated_at;
    Se2 best;
    double since_update_m = config.gate.linear_update_m;
    for (const Observation& observation : observations) {
      since_update_m += observation.motion.distance_m;
      const Estimate estimate = estimator.update(observation);
      if (since_update_m < config.gate.linear_update_m) continue;
      since_update_m = 0.0;
      best = estimate.map_from_base;
      generations.push_back(estimator.particles());
      updated_at.push_back(observation.time);
    }
    const std::vector<TimedPose> trajectory = estimator.trajectory();
    ASSERT_EQ(trajectory.size(), observations.size());
    ASSERT_GT(generations.size(), 10U);
    for (std::size_t update = generations.size(); update-- > 0;) {
      const auto pose = std::find_if(trajectory.begin(), trajectory.end(), [&](const TimedPose& p) {
        return p.time == updated_at[update];
      });
      ASSERT_NE(pose, trajectory.end());
      EXPECT_EQ(pose->map_from_base.translation(), best.translation()) << update;
      EXPECT_EQ(pose->map_from_base.theta(), best.theta()) << update;
      const auto& generation = generations[update];
      const auto particle = std::find_if(generation.begin(), generation.end(), [&](const auto& p) {
        return p.map_from_base.translation() == best.translation();
      });
      ASSERT_NE(particle, generation.end());
      best = particle->previous_map_from_base;
    }
  }
}

TEST(GmappingEstimator, SurvivesScansWithoutBeams) {
  GmappingEstimator estimator{EstimatorSetup{}, GmappingConfig{}};
  Observation observation;
  observation.motion = Motion::between({}, {1.5, 0.0, 0.0});
  for (int i = 0; i < 3; ++i)
    EXPECT_TRUE(std::isfinite(estimator.update(observation).map_from_base.x()));
  EXPECT_EQ(estimator.map().occupancy.num_tiles(), 0U);
}

}  // namespace
}  // namespace waymark
