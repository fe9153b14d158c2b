// SPDX-License-Identifier: BSD-3-Clause
#include "slam/core/motion/odometry_mixture.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace waymark {
namespace {

constexpr double kHalfTrack_m = 0.14;

Eigen::Matrix3d likeliest_covariance(const Eigen::Vector3d& residual,
                                     const Eigen::Matrix3d& rolling) {
  const MixtureNoise noise{rolling, rolling, kHalfTrack_m};
  return covariance_of(likeliest_kind(residual, noise), noise);
}

TEST(OdometryMixture, ASlippingWheelCorrectsDistanceAndTurnTogether) {
  const Eigen::Matrix3d rolling = Eigen::Vector3d{1e-6, 1e-6, 1e-5}.asDiagonal();
  for (const double turn_rad : {0.05, -0.05}) {
    const Eigen::Matrix3d slips = likeliest_covariance({0.0, 0.0, turn_rad}, rolling);
    // Correlation of distance with the amount of turn: negative, whichever wheel slips.
    EXPECT_LT(slips(0, 2) / slips(2, 2) * turn_rad, -0.1 * std::abs(turn_rad));
  }
  EXPECT_EQ(likeliest_covariance({0.0005, 0.0, 0.002}, rolling), rolling);
}

TEST(OdometryMixture, SlipsDoNotScaleWithTheLearntNoise) {
  const Eigen::Matrix3d described = Eigen::Vector3d{1e-6, 1e-6, 1e-5}.asDiagonal();
  const Eigen::Matrix3d learnt = 400.0 * described;
  for (const MotionKind kind :
       {MotionKind::kLeftSlips, MotionKind::kDisturbed, MotionKind::kGrossError}) {
    const Eigen::Matrix3d as_described = covariance_of(kind, {described, described, kHalfTrack_m});
    const Eigen::Matrix3d as_learnt = covariance_of(kind, {learnt, described, kHalfTrack_m});
    EXPECT_LT((as_learnt - as_described - (learnt - described)).norm(), 1e-12);
  }
}

TEST(OdometryMixture, StandingOdometryDoesNotKeepAMovingRobotInPlace) {
  const Eigen::Matrix3d standing = 1e-9 * Eigen::Matrix3d::Identity();
  const Eigen::Matrix3d estimated = likeliest_covariance({0.2, 0.0, 0.0}, standing);
  EXPECT_GT(std::sqrt(estimated(0, 0)), 0.05);
  EXPECT_NEAR(std::sqrt(likeliest_covariance({3e-5, 0.0, 0.0}, standing)(0, 0)), std::sqrt(1e-9),
              1e-6);
}

}  // namespace
}  // namespace waymark
