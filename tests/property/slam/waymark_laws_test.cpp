// SPDX-License-Identifier: BSD-3-Clause
// Laws of the whole estimator over simulated drives and seeds.
#include "common/random/random.hpp"
#include "estimator_run.hpp"
#include "slam/core/estimators/waymark.hpp"
#include "support/room_with_column.hpp"

#include <Eigen/Eigenvalues>
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <vector>

namespace waymark {
namespace {

using test::corridor_with_markers;
using test::estimator_setup_of;
using test::run;
using test::run_waymark;
using test::SensorLog;
using test::setup_of;
using test::Step;
using test::SyntheticCorridor;

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
    const std::vector<Step> steps = run_waymark(drive(corridor), corridor);
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

TEST(WaymarkEstimator, EqualLogsGiveEqualResultsToTheLastBit) {
  const SyntheticCorridor corridor = corridor_with_markers(2);
  const SensorLog log = drive(corridor);
  const std::vector<Step> one = run_waymark(log, corridor);
  const std::vector<Step> other = run_waymark(log, corridor);
  ASSERT_EQ(one.size(), other.size());
  for (std::size_t i = 0; i < one.size(); ++i) {
    EXPECT_EQ(one[i].estimate.map_from_base.x(), other[i].estimate.map_from_base.x());
    EXPECT_EQ(one[i].estimate.covariance, other[i].estimate.covariance);
  }
}

TEST(WaymarkEstimator, AMirroredWorldGivesAMirroredResult) {
  const SyntheticCorridor corridor = corridor_with_markers(3);
  const SensorLog log = drive(corridor);
  const std::vector<Step> left = run_waymark(log, corridor);
  const std::vector<Step> right = run_waymark(mirrored(log), corridor);
  ASSERT_EQ(left.size(), right.size());
  for (std::size_t i = 0; i < left.size(); ++i) {
    EXPECT_NEAR(left[i].estimate.map_from_base.x(), right[i].estimate.map_from_base.x(), 1e-3);
    EXPECT_NEAR(left[i].estimate.map_from_base.y(), -right[i].estimate.map_from_base.y(), 1e-3);
  }
}

TEST(WaymarkEstimator, CovariancesAreSymmetricAndPositive) {
  const SyntheticCorridor corridor = corridor_with_markers(1);
  for (const Step& step : run_waymark(drive(corridor), corridor)) {
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

TEST(WaymarkEstimator, TheFinalTrajectoryIsNoLessAccurateAlongTheCorridorThanLive) {
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

/// A stuck encoder reports no motion for a while, then at once all motion of that time.
void make_stuck(std::vector<Observation>& scans, std::size_t begin, std::size_t end) {
  Motion late_motion;
  for (std::size_t i = begin; i < end; ++i) {
    late_motion = late_motion.then(scans[i].motion);
    scans[i].motion = {};
  }
  scans[end].motion = late_motion.then(scans[end].motion);
  scans[end].odometry_caught_up = true;
}

TEST(WaymarkEstimator, LateMotionIsNotCountedTwice) {
  const SyntheticCorridor corridor = corridor_with_markers(1);
  std::vector<Observation> scans = test::observations_of(drive(corridor), corridor);
  make_stuck(scans, scans.size() / 3, 2 * scans.size() / 3);
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

/// The robot stands for a while and drives on, both while its encoder is stuck: markers show when.
TEST(WaymarkEstimator, TheFinalTrajectoryFollowsMarkersWhileOdometryIsStuck) {
  const SyntheticCorridor corridor = corridor_with_markers(1);
  std::vector<Observation> scans;
  SensorQueue queue{setup_of(corridor)};
  test::feed(queue, drive(corridor),
             [&scans](const SensorQueue::Ready& ready) { scans.push_back(ready.observation); });
  std::size_t begin = scans.size() / 3;
  while (scans[begin].sightings.empty())
    ++begin;
  const std::size_t end = 2 * scans.size() / 3;
  constexpr int kPause = 60;
  constexpr std::chrono::milliseconds kStep{200};
  Observation pause = scans[begin];
  pause.motion = {};
  for (std::size_t i = begin + 1; i < scans.size(); ++i)
    scans[i].time += kPause * kStep;
  for (int i = kPause; i > 0; --i) {
    pause.time = scans[begin].time + i * kStep;
    for (MarkerSighting& sighting : pause.sightings)
      sighting.time = pause.time;
    scans.insert(scans.begin() + static_cast<std::ptrdiff_t>(begin) + 1, pause);
  }
  WaymarkEstimator sound{estimator_setup_of(corridor, 1), {}};
  for (const Observation& scan : scans)
    sound.update(scan);
  make_stuck(scans, begin + 1, end + kPause);
  WaymarkEstimator stuck{estimator_setup_of(corridor, 1), {}};
  for (const Observation& scan : scans)
    stuck.update(scan);
  const std::vector<TimedPose> expected = sound.trajectory();
  const std::vector<TimedPose> found = stuck.trajectory();
  ASSERT_EQ(found.size(), expected.size());
  double worst_m = 0.0;
  for (std::size_t i = 0; i < found.size(); ++i) {
    const Eigen::Vector2d off =
        found[i].map_from_base.translation() - expected[i].map_from_base.translation();
    worst_m = std::max(worst_m, off.norm());
  }
  EXPECT_LT(worst_m, 0.3);
}

/// Three quarters of the walls are seen a little farther away, so that the scan is not used.
TEST(WaymarkEstimator, AScanThatIsNotUsedGivesNoTrackingHealth) {
  const SyntheticCorridor corridor = corridor_with_markers(1);
  WaymarkEstimator estimator{estimator_setup_of(corridor, 1), {}};
  int seen = 0;
  const auto handle = [&](Observation& observation, bool) {
    const bool is_changed = ++seen > 8;
    for (std::size_t i = 0; i < observation.beams.size(); ++i)
      if (is_changed && i / 10 % 4 != 0) observation.beams[i].beam.end_in_base *= 1.13;
    const Estimate estimate = estimator.update(observation);
    if (seen > 2) {
      EXPECT_EQ(estimate.health == Health::kTracking, !is_changed) << seen;
    }
  };
  test::drive_through_room(Motion::between({}, {0.1, 0.0, 0.02}), -1, {}, handle);
}

TEST(WaymarkEstimator, ScansOfRandomRangesAreNotMapped) {
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
