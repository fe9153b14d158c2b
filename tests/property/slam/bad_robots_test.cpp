// SPDX-License-Identifier: BSD-3-Clause
// Robots whose sensors are worse than described: the error stays small where markers or walls
// observe the motion, the covariance is consistent where they do not, and findings are reported.
#include "common/random/random.hpp"
#include "estimator_run.hpp"
#include "slam/core/estimators/waymark.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

namespace waymark {
namespace {

using test::SensorLog;
using test::Step;
using test::SyntheticCorridor;

struct Drives {
  double nees{0.0};               ///< mean
  double ate_m{0.0};              ///< worst RMS of the position
  double end_m{0.0};              ///< worst error at the end
  SensorStatistics statistics{};  ///< of the last one
};

SyntheticCorridor corridor_of(std::uint64_t seed) {
  SyntheticCorridor corridor;
  corridor.seed = seed;
  corridor.length_m = 24.0;
  corridor.drive_m = 20.0;
  corridor.speed_m_s = 0.2;
  corridor.markers = test::opposite_markers(corridor, 4.0, 4.0);
  return corridor;
}

/// The estimator knows the description only. NEES counts from `from_m` driven on.
Drives drive_all(const std::function<void(SyntheticCorridor&)>& make_worse,
                 const std::function<void(SensorLog&, Random&)>& corrupt, double from_m = 0.0,
                 std::uint64_t seeds = 4) {
  Drives drives;
  for (std::uint64_t seed = 1; seed <= seeds; ++seed) {
    SyntheticCorridor corridor = corridor_of(seed);
    const EstimatorSetup described = test::estimator_setup_of(corridor, seed);
    make_worse(corridor);
    SensorLog log = test::drive(corridor);
    Random random{seed, 99};
    corrupt(log, random);
    WaymarkEstimator estimator{described, {}};
    const std::vector<Step> steps = test::run(estimator, log, test::setup_of(corridor));
    double nees = 0.0;
    double squares = 0.0;
    std::size_t counted = 0;
    for (const Step& step : steps) {
      const Eigen::Vector3d error = pose_difference(step.estimate.map_from_base, step.truth);
      Eigen::Matrix3d covariance = step.estimate.covariance;
      covariance.diagonal().array() += 1e-10;  // the first pose is exact
      squares += error.head<2>().squaredNorm();
      if (step.truth.x() < from_m) continue;
      nees += error.dot(covariance.ldlt().solve(error));
      ++counted;
    }
    drives.nees += nees / static_cast<double>(counted) / static_cast<double>(seeds);
    drives.ate_m = std::max(drives.ate_m, std::sqrt(squares / static_cast<double>(steps.size())));
    drives.end_m = std::max(drives.end_m, (steps.back().estimate.map_from_base.translation() -
                                           steps.back().truth.translation())
                                              .norm());
    drives.statistics = *estimator.statistics();
  }
  return drives;
}

void as_described(SyntheticCorridor&) {}

void not_at_all(SensorLog&, Random&) {}

/// Odometry poses from index `from` on, moved as if `extra` had been driven there.
void insert_motion(SensorLog& log, std::size_t from, const Se2& extra) {
  const Se2 before = log.odometry[from].odom_from_base;
  for (std::size_t i = from; i < log.odometry.size(); ++i) {
    log.odometry[i].odom_from_base =
        before * extra * (before.inverse() * log.odometry[i].odom_from_base);
  }
}

/// First and last of the samples in which the robot drives from 8 to 8 + `way_m` metres.
std::pair<std::size_t, std::size_t> samples_of(double way_m) {
  constexpr double kPerMetre = 30.0 / 0.2;
  return {static_cast<std::size_t>(8.0 * kPerMetre),
          static_cast<std::size_t>((8.0 + way_m) * kPerMetre)};
}

TEST(BadRobots, ARobotAsDescribedHasNoFindings) {
  const Drives drives = drive_all(as_described, not_at_all);
  EXPECT_LT(drives.nees, 5.0);
  EXPECT_LT(drives.statistics.odometry_turn, 1.9);
  EXPECT_LT(drives.statistics.odometry_along, 1.9);
  EXPECT_LT(drives.statistics.range_sigma_m, 1.3 * drives.statistics.described_range_sigma_m);
  EXPECT_EQ(drives.statistics.odometry_stuck, 0);
  EXPECT_EQ(drives.statistics.scans_rescaled, 0);
  EXPECT_LT(100 * drives.statistics.beams_moving, drives.statistics.beams);
}

TEST(BadRobots, NoisyOdometryIsDetectedAndTheCovarianceConsistent) {
  const Drives drives = drive_all(
      [](SyntheticCorridor& corridor) {
        corridor.along_noise_per_sqrt_m = 0.02;
        corridor.turn_noise_per_sqrt_m = 0.035;
      },
      not_at_all);
  EXPECT_LT(drives.nees, 5.0);
  EXPECT_GT(drives.statistics.odometry_turn, 2.0);
  EXPECT_GT(drives.statistics.odometry_along, 2.0);
}

/// Wheels slip after the second pair of markers: before the first pair nothing shows slips.
TEST(BadRobots, WheelSlipIsDetectedAndTheCovarianceConsistent) {
  constexpr double kSecondMarkers_m = 8.0;
  const Drives drives = drive_all(
      as_described,
      [](SensorLog& log, Random& random) {
        for (std::size_t i = log.odometry.size() - 1; i > 0; --i)
          if (random.uniform() < 0.7 * 0.2 / 30.0)
            insert_motion(log, i, {-0.1 * std::log(1.0 - random.uniform()), 0.0, 0.0});
      },
      kSecondMarkers_m);
  EXPECT_LT(drives.nees, 8.0);
  EXPECT_GT(drives.statistics.slips, 2);
}

TEST(BadRobots, BurstsOfGarbageDoNotDegradeThePoseAndAreReported) {
  const Drives drives = drive_all(as_described, [](SensorLog& log, Random& random) {
    for (const double way_m : {0.1, 0.3}) {
      const auto [from, to] = samples_of(way_m);
      for (std::size_t i = from; i < to; ++i) {
        log.odometry[i].odom_from_base =
            log.odometry[i].odom_from_base *
            Se2{random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0), random.uniform(-3.1, 3.1)};
      }
    }
  });
  EXPECT_LT(drives.nees, 5.0);
  EXPECT_LT(drives.ate_m, 0.06);
  EXPECT_GT(drives.statistics.odometry_jumping, 0);
}

TEST(BadRobots, StuckOdometryIsDetectedAndItsLateMotionUsed) {
  const Drives drives = drive_all(as_described, [](SensorLog& log, Random&) {
    const auto [from, to] = samples_of(2.0);
    for (std::size_t i = from; i < to; ++i)
      log.odometry[i].odom_from_base = log.odometry[from].odom_from_base;
  });
  EXPECT_LT(drives.nees, 8.0);
  EXPECT_GT(drives.statistics.odometry_stuck, 10);
  EXPECT_EQ(drives.statistics.odometry_caught_up, 1);
}

/// The standstill is so long that the keyframe where it began has left the window.
TEST(BadRobots, LateMotionAfterALongStandstillIsUsed) {
  const Drives drives = drive_all(as_described, [](SensorLog& log, Random&) {
    const auto [from, to] = samples_of(6.0);
    for (std::size_t i = from; i < to; ++i)
      log.odometry[i].odom_from_base = log.odometry[from].odom_from_base;
  });
  EXPECT_EQ(drives.statistics.odometry_caught_up, 1);
  EXPECT_LT(drives.end_m, 0.06);
}

TEST(BadRobots, OdometryThatNeverMovesIsReportedAndTheCovarianceConsistent) {
  const Drives drives = drive_all(as_described, [](SensorLog& log, Random&) {
    for (OdometrySample& sample : log.odometry)
      sample.odom_from_base = {};
  });
  EXPECT_GT(drives.statistics.odometry_stuck, drives.statistics.observations / 2);
  EXPECT_LT(drives.nees, 5.0);
}

TEST(BadRobots, FalseOdometryTurnsAreNotTakenForAWrongRangeScale) {
  const Drives drives = drive_all(as_described, [](SensorLog& log, Random& random) {
    for (std::size_t i = 600; i < log.odometry.size(); i += 300) {
      const double turn_rad = random.uniform(0.2, 0.5);
      insert_motion(log, i, {0.0, 0.0, i % 600 == 0 ? turn_rad : -turn_rad});
    }
  });
  EXPECT_EQ(drives.statistics.scans_rescaled, 0);
  EXPECT_LT(drives.ate_m, 0.06);
}

TEST(BadRobots, OdometryThatLosesMotionIsDetected) {
  const Drives drives = drive_all(as_described, [](SensorLog& log, Random&) {
    const auto [from, to] = samples_of(2.0);
    const Se2 held = log.odometry[from].odom_from_base;
    const Se2 lost = log.odometry[to].odom_from_base.inverse();
    for (std::size_t i = from; i < log.odometry.size(); ++i) {
      log.odometry[i].odom_from_base =
          i < to ? held : held * (lost * log.odometry[i].odom_from_base);
    }
  });
  EXPECT_LT(drives.nees, 12.0);
  EXPECT_LT(drives.ate_m, 0.3);
  EXPECT_GT(drives.statistics.odometry_stuck, 10);
}

TEST(BadRobots, PeopleWalkingBesideTheRobotAreExcludedAndReported) {
  const auto with_people = [](SensorLog& log, Random& random) {
    for (std::size_t i = 0; i < log.scans.size(); ++i) {
      const double time_s = 0.2 * static_cast<double>(i);
      std::vector<double>& ranges_m = log.scans[i].ranges_m;
      const auto beams = static_cast<double>(ranges_m.size());
      for (int person = 1; person <= 3; ++person) {
        const double toward = 0.5 + 0.45 * std::sin(0.1 * person * time_s + person);
        const double away_m = 0.7 + 0.15 * std::sin(0.3 * time_s + person);
        for (std::size_t k = 0; k < ranges_m.size(); ++k)
          if (std::abs(static_cast<double>(k) / beams - toward) < 0.03 && ranges_m[k] > away_m)
            ranges_m[k] = away_m + random.normal(0.0, 0.01);
      }
    }
  };
  const Drives drives = drive_all(as_described, with_people, 0.0, 20);
  EXPECT_LT(drives.nees, 5.0);
  EXPECT_LT(drives.ate_m, 0.04);
  EXPECT_LT(drives.statistics.odometry_along, 1.9);
  EXPECT_GT(20 * drives.statistics.beams_moving, drives.statistics.beams);
}

/// The map's frame is the LiDAR's first pose, as it is taken to be mounted.
TEST(BadRobots, ALidarThatIsMountedAskewIsReportedAndCorrected) {
  constexpr double kYaw_rad = 4.0 * std::numbers::pi / 180.0;  // four beams
  const SyntheticCorridor corridor = corridor_of(1);
  SensorLog log = test::drive(corridor);
  for (LidarScan& scan : log.scans)
    std::ranges::rotate(scan.ranges_m, scan.ranges_m.begin() + 4);
  WaymarkEstimator estimator{test::estimator_setup_of(corridor, 1), {}};
  const std::vector<Step> steps = test::run(estimator, log, test::setup_of(corridor));
  const Se2 mounting{0.0, 0.0, kYaw_rad};
  for (const Step& step : steps) {
    const Se2 expected = mounting.inverse() * step.truth * mounting;
    EXPECT_LT(pose_difference(step.estimate.map_from_base, expected).head<2>().norm(), 0.1);
  }
  const std::vector<Miscalibration> found = estimator.statistics()->miscalibrated;
  const auto yaw =
      std::ranges::find(found, std::size_t{OdometryTerm::kLidarYaw}, &Miscalibration::term);
  ASSERT_NE(yaw, found.end());
  EXPECT_NEAR(yaw->error, kYaw_rad, 0.005);
}

TEST(BadRobots, RangeNoiseIsLearnt) {
  const Drives drives =
      drive_all([](SyntheticCorridor& corridor) { corridor.range_sigma_m = 0.04; }, not_at_all);
  EXPECT_LT(drives.nees, 5.0);
  EXPECT_NEAR(drives.statistics.range_sigma_m, 0.04, 0.008);
}

TEST(BadRobots, AWrongRangeScaleIsCorrectedAndReported) {
  const Drives drives = drive_all(as_described, [](SensorLog& log, Random&) {
    for (std::size_t i = log.scans.size() / 2; i < log.scans.size() / 2 + 50; ++i)
      for (double& range_m : log.scans[i].ranges_m)
        range_m *= 1.05;
  });
  EXPECT_LT(drives.nees, 5.0);
  EXPECT_LT(drives.ate_m, 0.04);
  EXPECT_NEAR(static_cast<double>(drives.statistics.scans_rescaled), 50.0, 5.0);
  EXPECT_NEAR(drives.statistics.range_scale_error, 0.05, 0.01);
}

}  // namespace
}  // namespace waymark
