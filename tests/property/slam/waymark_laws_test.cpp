// SPDX-License-Identifier: BSD-3-Clause
// Laws of the whole estimator over simulated drives and seeds.
#include "common/random/random.hpp"
#include "estimator_run.hpp"
#include "slam/core/estimators/waymark.hpp"

#include <Eigen/Eigenvalues>
#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <memory>
#include <vector>

namespace waymark {
namespace {

using test::estimator_setup_of;
using test::run;
using test::SensorLog;
using test::setup_of;
using test::Step;
using test::SyntheticCorridor;

std::vector<Step> run_graph(const SensorLog& log, const SyntheticCorridor& corridor) {
  WaymarkEstimator estimator{estimator_setup_of(corridor, 1), {}};
  return run(estimator, log, setup_of(corridor));
}

SyntheticCorridor corridor_with_markers(std::uint64_t seed) {
  SyntheticCorridor corridor = test::short_corridor(seed);
  corridor.markers = test::opposite_markers(corridor, 2.0, 2.0);
  return corridor;
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

TEST(WaymarkEstimator, VarianceAlongABareCorridorNeverShrinks) {
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    const SyntheticCorridor corridor = between_two_walls(seed);
    const std::vector<Step> steps = run_graph(drive(corridor), corridor);
    double most = 0.0;
    for (const Step& step : steps) {
      const double variance_m2 = step.estimate.covariance(0, 0);
      // By the turn of the heading a little of across is in it: a part in a thousand.
      EXPECT_GT(variance_m2, 0.999 * most - 1e-7);
      most = std::max(most, variance_m2);
    }
    EXPECT_GT(std::sqrt(most), 0.02);  // the odometry's scale is known to 2 %
  }
}

TEST(WaymarkEstimator, MarkersBoundTheErrorAndItsCovarianceIsConsistent) {
  double nees = 0.0;
  int count = 0;
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    const SyntheticCorridor corridor = corridor_with_markers(seed);
    const std::vector<Step> steps = run_graph(drive(corridor), corridor);
    EXPECT_LT(test::along_rmse_m(steps), 0.02) << "seed " << seed;
    for (std::size_t i = steps.size() / 4; i < steps.size(); ++i) {
      Eigen::Vector3d error{
          steps[i].estimate.map_from_base.x() - steps[i].truth.x(),
          steps[i].estimate.map_from_base.y() - steps[i].truth.y(),
          angle_difference(steps[i].estimate.map_from_base.theta(), steps[i].truth.theta())};
      nees += error.dot(steps[i].estimate.covariance.ldlt().solve(error));
      ++count;
    }
  }
  EXPECT_LT(nees / count, 8.0);  // 3 degrees of freedom; four drives are few
}

TEST(WaymarkEstimator, EqualLogsGiveEqualResultsToTheLastBit) {
  const SyntheticCorridor corridor = corridor_with_markers(2);
  const SensorLog log = drive(corridor);
  const std::vector<Step> one = run_graph(log, corridor);
  const std::vector<Step> other = run_graph(log, corridor);
  ASSERT_EQ(one.size(), other.size());
  for (std::size_t i = 0; i < one.size(); ++i) {
    EXPECT_EQ(one[i].estimate.map_from_base.x(), other[i].estimate.map_from_base.x());
    EXPECT_EQ(one[i].estimate.covariance, other[i].estimate.covariance);
  }
}

TEST(WaymarkEstimator, AMirroredWorldGivesAMirroredResult) {
  const SyntheticCorridor corridor = corridor_with_markers(3);
  const SensorLog log = drive(corridor);
  const std::vector<Step> left = run_graph(log, corridor);
  const std::vector<Step> right = run_graph(mirrored(log), corridor);
  ASSERT_EQ(left.size(), right.size());
  for (std::size_t i = 0; i < left.size(); ++i) {
    EXPECT_NEAR(left[i].estimate.map_from_base.x(), right[i].estimate.map_from_base.x(), 1e-3);
    EXPECT_NEAR(left[i].estimate.map_from_base.y(), -right[i].estimate.map_from_base.y(), 1e-3);
  }
}

TEST(WaymarkEstimator, CovariancesAreSymmetricAndPositive) {
  const SyntheticCorridor corridor = corridor_with_markers(1);
  for (const Step& step : run_graph(drive(corridor), corridor)) {
    const Eigen::Matrix3d& covariance = step.estimate.covariance;
    EXPECT_EQ(covariance, covariance.transpose());
    EXPECT_GE(Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>{covariance}.eigenvalues()[0], 0.0);
  }
}

TEST(WaymarkEstimator, AnEmptyScanNeitherCrashesNorMoves) {
  const SyntheticCorridor corridor = corridor_with_markers(1);
  WaymarkEstimator estimator{estimator_setup_of(corridor, 1), {}};
  run(estimator, drive(corridor), setup_of(corridor));
  Observation nothing;
  const Se2 before = estimator.update(nothing).map_from_base;
  for (int i = 0; i < 5; ++i)
    EXPECT_EQ(estimator.update(nothing).map_from_base.x(), before.x());
}

/// Ids of a detector that sees markers in noise, in a map that is not added to.
TEST(WaymarkEstimator, AFloodOfIdsIsBounded) {
  constexpr std::size_t kMost = 4096;
  constexpr int kInAFrame = 2;
  constexpr double kStep_m = 5.0;  // landmarks leave the window soon
  EstimatorSetup setup;
  setup.map_mode = MapMode::kLocalise;
  setup.loaded_map = std::make_shared<MapSnapshot>();
  WaymarkEstimator estimator{setup, {}};
  int id = 0;
  for (int k = 0; id < 5000; ++k) {
    Observation observation;
    observation.time = timestamp_from_us(std::int64_t{1000000} * (k + 1));
    observation.elapsed_s = 1.0;
    if (k > 0) observation.motion = Motion::between({}, {kStep_m, 0.0, 0.0});
    for (int i = 0; i < kInAFrame; ++i) {
      MarkerSighting seen;
      seen.id = ++id;
      seen.time = observation.time;
      seen.base_from_marker = {1.5, 1.0 * i, 3.1};
      seen.covariance_in_base = 1e-4 * Eigen::Matrix3d::Identity();
      observation.sightings.push_back(seen);
    }
    estimator.update(observation);
  }
  EXPECT_EQ(estimator.landmarks().size(), kMost);
}

TEST(WaymarkEstimator, ACommandedPoseIsNotTakenForStuckOdometry) {
  const SyntheticCorridor corridor = corridor_with_markers(1);
  WaymarkEstimator estimator{estimator_setup_of(corridor, 1), {}};
  run(estimator, drive(corridor), setup_of(corridor));
  Observation standing;
  standing.elapsed_s = 0.2;
  const auto stand = [&](int observations) {
    Estimate estimate;
    for (int i = 0; i < observations; ++i) {
      standing.time += std::chrono::milliseconds{200};
      estimate = estimator.update(standing);
    }
    return estimate;
  };
  const Se2 before = stand(20).map_from_base;
  StartPose given;
  given.kind = StartKind::kPose;
  given.x_m = before.x() + 5.0;
  given.y_m = before.y();
  ASSERT_TRUE(estimator.set_pose(given));
  const Estimate after = stand(100);
  EXPECT_NEAR(after.map_from_base.x(), given.x_m, 1e-3);
  EXPECT_LT(std::sqrt(after.covariance(0, 0)), 1.0);
}

TEST(WaymarkEstimator, ACommandedPoseOutsideTheLargestGridIsRefused) {
  const SyntheticCorridor corridor = corridor_with_markers(1);
  WaymarkEstimator estimator{estimator_setup_of(corridor, 1), {}};
  run(estimator, drive(corridor), setup_of(corridor));
  StartPose far;
  far.kind = StartKind::kPose;
  far.x_m = 1e5;
  EXPECT_FALSE(estimator.set_pose(far));
}

TEST(WaymarkEstimator, TheFinalTrajectoryIsNoWorseThanTheOneWhileDriving) {
  const SyntheticCorridor corridor = corridor_with_markers(4);
  WaymarkEstimator estimator{estimator_setup_of(corridor, 1), {}};
  const std::vector<Step> steps = run(estimator, drive(corridor), setup_of(corridor));
  const std::vector<TimedPose> trajectory = estimator.trajectory();
  ASSERT_EQ(trajectory.size(), steps.size());
  double sum = 0.0;
  for (std::size_t i = 0; i < steps.size(); ++i)
    sum += std::pow(trajectory[i].map_from_base.x() - steps[i].truth.x(), 2);
  EXPECT_LT(std::sqrt(sum / static_cast<double>(steps.size())), test::along_rmse_m(steps) + 0.005);
}

/// Up and down the same corridor: the graph grows with the area, and is as good as one that keeps
/// everything.
TEST(WaymarkEstimator, RevisitingAPlaceDoesNotMakeTheGraphGrow) {
  SyntheticCorridor corridor = corridor_with_markers(5);
  corridor.speed_m_s = 1.0;
  corridor.length_m = 7.0;
  corridor.turn_back_every_m = 5.0;
  corridor.markers = test::opposite_markers(corridor, 2.0, 3.0);
  const auto graph_after = [&](int passes, int per_place, double& error_m) {
    corridor.drive_m = corridor.turn_back_every_m * passes;
    WaymarkConfig config;
    config.keyframes_per_place = per_place;
    WaymarkEstimator estimator{estimator_setup_of(corridor, 1), config};
    error_m = test::along_rmse_m(run(estimator, drive(corridor), setup_of(corridor)));
    return static_cast<double>(estimator.pose_graph()->poses.size());
  };
  constexpr int kFew = 10;
  constexpr int kAll = 100000;
  double error_m = 0.0;
  double error_of_all_m = 0.0;
  const double half = graph_after(16, kFew, error_m);
  const double whole = graph_after(32, kFew, error_m);
  const double all = graph_after(32, kAll, error_of_all_m);
  EXPECT_LT(whole, 1.1 * half);
  EXPECT_GT(all, 2.0 * whole);
  EXPECT_LT(error_m, 1.1 * error_of_all_m + 0.001);
}

/// The first one makes the solver step the whole graph, for which the second one must not stand in
/// the window without a measurement.
TEST(WaymarkEstimator, AReturningMarkerAndANewOneInOneScanAreBothUsed) {
  SyntheticCorridor corridor = corridor_with_markers(3);
  corridor.speed_m_s = 1.0;
  corridor.length_m = 40.0;
  corridor.turn_back_every_m = 30.0;
  corridor.drive_m = 60.0;
  corridor.markers = test::opposite_markers(corridor, 4.0, 4.0);
  SensorLog log = drive(corridor);
  constexpr int kHungUpMeanwhile = 4;  // opposite of marker 5
  for (std::size_t i = 0; i < log.frames.size() / 2; ++i) {
    std::erase_if(log.frames[i].detections, [](const MarkerDetection& detection) {
      return detection.id == kHungUpMeanwhile;
    });
  }
  const std::vector<Step> steps = run_graph(log, corridor);
  for (const Step& step : steps)
    ASSERT_TRUE(step.estimate.covariance.allFinite());
  EXPECT_LT(test::along_rmse_m(steps), 0.05);
  EXPECT_FALSE(steps.back().estimate.calibration_widened);
}

/// A stuck encoder: nothing for a while, then at once what was driven meanwhile.
TEST(WaymarkEstimator, LateMotionIsNotCountedTwice) {
  const SyntheticCorridor corridor = corridor_with_markers(1);
  std::vector<Observation> scans = test::observations_of(drive(corridor), corridor);
  const std::size_t begin = scans.size() / 3;
  const std::size_t end = 2 * scans.size() / 3;
  Motion late_motion;
  for (std::size_t i = begin; i < end; ++i) {
    late_motion = late_motion.then(scans[i].motion);
    scans[i].motion = {};
  }
  scans[end].motion = late_motion.then(scans[end].motion);
  scans[end].odometry_caught_up = true;
  WaymarkEstimator stuck{estimator_setup_of(corridor, 1), {}};
  WaymarkEstimator sound{estimator_setup_of(corridor, 1), {}};
  Se2 with_gap;
  Se2 without_gap;
  for (const Observation& scan : scans)
    with_gap = stuck.update(scan).map_from_base;
  for (const Observation& scan : test::observations_of(drive(corridor), corridor))
    without_gap = sound.update(scan).map_from_base;
  EXPECT_LT((with_gap.translation() - without_gap.translation()).norm(), 0.1);
}

TEST(WaymarkEstimator, ARandomScanIsNotMapped) {
  const SyntheticCorridor corridor = corridor_with_markers(2);
  std::vector<Observation> scans = test::observations_of(drive(corridor), corridor);
  WaymarkEstimator dirty{estimator_setup_of(corridor, 1), {}};
  Random random{7, 0};
  for (std::size_t i = 0; i < scans.size(); ++i) {
    if (i > scans.size() / 2 && i < scans.size() / 2 + 20) {
      for (AnnotatedBeam& annotated : scans[i].beams) {
        const Eigen::Vector2d ray = annotated.beam.end_in_base - annotated.beam.start_in_base;
        annotated.beam.range_m = random.uniform() * 8.0;
        annotated.beam.end_in_base =
            annotated.beam.start_in_base + annotated.beam.range_m * ray.normalized();
      }
    }
    dirty.update(scans[i]);
  }
  const GridMap& map = dirty.map();
  int outside = 0;
  for (double x = -2.0; x < 12.0; x += map.frame.resolution_m)
    for (double y = 0.5 * corridor.width_m + 0.3; y < 6.0; y += map.frame.resolution_m)
      for (const double side : {-y, y})
        outside += map.occupancy[map.frame.cell_of({x, side})].occupancy() > 0.5;
  EXPECT_EQ(outside, 0);
}

}  // namespace
}  // namespace waymark
