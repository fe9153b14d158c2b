// SPDX-License-Identifier: BSD-3-Clause
// Cameras and markers that are worse than the robot has been told.
#include "property/slam/estimator_run.hpp"
#include "slam/core/belief/belief.hpp"
#include "slam/core/estimators/waymark.hpp"
#include "slam/slam_config.hpp"
#include "support/small_world.hpp"

#include <gtest/gtest.h>

namespace waymark {
namespace {

using test::diagonal;
using test::measurement_of;

constexpr auto kYaw = SightingSigmas::kYaw;
constexpr auto kFocal = SightingSigmas::kFocal;
constexpr double kGate = 16.3;
const Eigen::Vector3d kNarrow = test::exact_camera().learnt;
const Eigen::Vector3d kWide = SightingSigmas{}.learnt;

/// Drives up to a marker; what the camera's errors do to each sighting is in it.
void drive_by(Belief& belief, const Eigen::Vector3d& errors, std::uint64_t seed) {
  const Se2 map_from_marker{3.0, 1.0, radians(-90.0)};
  Random random{21, seed};
  for (int i = 0; i < 40; ++i) {
    if (i > 0) belief.move({Se2{0.05, 0.0, 0.0}, 0.05, 0.0}, {});
    const Se2 base_from_marker = Se2{0.05 * i, 0.0, 0.0}.inverse() * map_from_marker;
    MarkerMeasurement seen = measurement_of(base_from_marker);
    seen.held.setIdentity();
    seen.covariance = diagonal(0.002, 0.002, 0.002);
    seen.by_camera = seen.by_errors_at(base_from_marker.translation()).leftCols<2>();
    const Eigen::Vector3d noise{random.normal(0.0, 0.002), random.normal(0.0, 0.002),
                                random.normal(0.0, 0.002)};
    seen.base_from_marker = deviated(base_from_marker, seen.by_errors() * errors + noise);
    if (i == 0) {
      belief.add(seen);
    } else {
      belief.correct(0, seen, kGate);
    }
  }
}

TEST(SightingSigmas, ADoubtedErrorIsAsWideAsItSeemsAndNothingIsBetterThanUsual) {
  const Eigen::Vector3d none = Eigen::Vector3d::Zero();
  const SightingSigmas usual;
  const SightingSigmas told = test::exact_camera();
  // Sightings that know the focal length as well as it was told find it half as far off as it is.
  Eigen::Vector3d variances = told.learnt.cwiseAbs2();
  variances[kFocal] *= 0.5;
  Eigen::Vector3d found = none;
  found[kFocal] = 0.5 * 0.01;
  const auto once = told.doubted_by(found, variances, none);
  ASSERT_TRUE(once);
  EXPECT_NEAR(once->learnt[kFocal], 0.01, 1e-9);
  EXPECT_EQ(once->learnt[kYaw], usual.learnt[kYaw]);
  EXPECT_EQ(once->learnt[SightingSigmas::kStandoff], usual.learnt[SightingSigmas::kStandoff]);
  EXPECT_EQ(once->bearing_rad, usual.bearing_rad);
  EXPECT_EQ(once->position_m, usual.position_m);
  EXPECT_FALSE(once->doubted_by(found, once->learnt.cwiseAbs2() * 0.01, none));
  EXPECT_FALSE(told.doubted_by(found, variances, Eigen::Vector3d::Constant(1e-5)));
}

TEST(SightingSigmas, AreThoseOfARobotThatIsToldNothing) {
  const SightingSigmas told = estimator_setup(SlamConfig{}).sighting_sigmas;
  const SightingSigmas usual;
  EXPECT_EQ(told.learnt, usual.learnt);
  EXPECT_EQ(told.bearing_rad, usual.bearing_rad);
  EXPECT_EQ(told.position_m, usual.position_m);
  EXPECT_EQ(told.bulge_m, usual.bulge_m);
  EXPECT_EQ(told.skew_rad, usual.skew_rad);
}

TEST(SightingSigmas, WhatIsExactStaysSo) {
  SightingSigmas sigmas;
  sigmas.learnt[kYaw] = 0.0;
  const Eigen::Vector3d found{0.0, 0.1, 0.0};
  const auto doubted = sigmas.doubted_by(found, Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero());
  ASSERT_TRUE(doubted);
  EXPECT_EQ(doubted->learnt[kYaw], 0.0);
  EXPECT_NEAR(doubted->learnt[kFocal], 0.1, 1e-9);
}

TEST(Belief, WithAPriorWidenedLaterIsTheOneThatBeganWithIt) {
  const Eigen::Vector3d errors{0.003, 0.0002, 0.0};
  const Eigen::Vector3d wide_sigmas{0.0087, 0.001, 0.003};
  Belief widened{{OdometryNoise{}, kNarrow}};
  Belief wide{{OdometryNoise{}, wide_sigmas}};
  drive_by(widened, errors, 1);
  drive_by(wide, errors, 1);
  const auto away = [&] {
    return deviation(widened.markers()[0].map_from_marker, wide.markers()[0].map_from_marker)
        .norm();
  };
  const double away_before = away();
  EXPECT_GT((widened.sighting_errors() - wide.sighting_errors()).norm(), 5e-4);
  widened.widen_prior(kNarrow, wide_sigmas);
  EXPECT_LT((widened.sighting_errors() - wide.sighting_errors()).norm(), 5e-5);
  EXPECT_TRUE(widened.errors_covariance().isApprox(wide.errors_covariance(), 0.02));
  EXPECT_TRUE(widened.pose_covariance().isApprox(wide.pose_covariance(), 0.02));
  EXPECT_LT(deviation(widened.map_from_base(), wide.map_from_base()).norm(), 5e-5);
  EXPECT_LT(away(), 0.05 * away_before);
}

TEST(SightingSigmas, AreContradictedWhereTheyAreTooNarrowAndNowhereElse) {
  const Eigen::Vector3d none = Eigen::Vector3d::Zero();
  const SightingSigmas told_wide;
  int false_alarms = 0;
  int alarms = 0;
  for (std::uint64_t seed = 1; seed <= 50; ++seed) {
    Random random{22, seed};
    Belief right{{OdometryNoise{}, kWide}};
    drive_by(right, {random.normal(0.0, kWide[kYaw]), random.normal(0.0, kWide[kFocal]), 0.0},
             seed);
    false_alarms +=
        told_wide.doubted_by(right.sighting_errors(), right.sighting_variances(), none).has_value();
    Belief wrong{{OdometryNoise{}, kNarrow}};
    drive_by(wrong, {0.015, 0.0, 0.0}, seed);
    const auto doubted =
        test::exact_camera().doubted_by(wrong.sighting_errors(), wrong.sighting_variances(), none);
    alarms += doubted && doubted->learnt[kYaw] > kWide[kYaw];
  }
  EXPECT_EQ(false_alarms, 0);
  EXPECT_EQ(alarms, 50);
}

TEST(Waymark, BelievesACameraLessThatIsWorseThanTold) {
  const auto drive = [](double focal_error, double yaw_error_rad) {
    test::SyntheticCorridor corridor = test::short_corridor(4);
    corridor.camera_focal_error = focal_error;
    corridor.camera_yaw_error_rad = yaw_error_rad;
    EstimatorSetup setup = test::estimator_setup_of(corridor, 4);
    setup.sighting_sigmas = test::exact_camera();
    WaymarkEstimator estimator{setup, {}};
    return test::run(estimator, test::drive(corridor), test::setup_of(corridor));
  };
  const auto widened = [](const std::vector<test::Step>& steps) {
    return std::any_of(steps.begin(), steps.end(),
                       [](const test::Step& step) { return step.estimate.calibration_widened; });
  };
  EXPECT_FALSE(widened(drive(0.0, 0.0)));
  for (const auto& [focal_error, yaw_error_rad] :
       {std::pair{0.02, 0.0}, std::pair{0.0, radians(0.3)}, std::pair{-0.01, radians(-0.5)}}) {
    const auto steps = drive(focal_error, yaw_error_rad);
    EXPECT_TRUE(widened(steps)) << focal_error << " " << yaw_error_rad;
    const Se2 error = steps.back().truth.inverse() * steps.back().estimate.map_from_base;
    const Eigen::Matrix3d& covariance = steps.back().estimate.covariance;
    EXPECT_LT(error.translation().norm(), 0.033) << focal_error << " " << yaw_error_rad;
    EXPECT_LT(std::abs(error.x()), 4.0 * std::sqrt(covariance(0, 0)));
  }
}

}  // namespace
}  // namespace waymark
