// SPDX-License-Identifier: BSD-3-Clause
#include "detector/core/square_pose.hpp"

#include "common/geometry/angle.hpp"
#include "common/random/random.hpp"

#include <Eigen/Cholesky>
#include <gtest/gtest.h>

namespace waymark {
namespace {

constexpr double kSizeM = 0.4;

/// A marker 2.5 m ahead, turned about its upright axis; 0 = facing the camera.
Eigen::Isometry3d turned_marker(double turn_rad) {
  Eigen::Isometry3d camera_from_marker = Eigen::Isometry3d::Identity();
  camera_from_marker.translation() = Eigen::Vector3d{0.2, 0.1, 2.5};
  // x right, y up, z towards the camera, in a frame of x right, y down, z forward.
  camera_from_marker.linear() = (Eigen::AngleAxisd{turn_rad, Eigen::Vector3d::UnitY()} *
                                 Eigen::AngleAxisd{radians(180), Eigen::Vector3d::UnitX()})
                                    .toRotationMatrix();
  return camera_from_marker;
}

MeasuredCorners corners_of(const Eigen::Isometry3d& camera_from_marker, double sigma_px,
                           Random* random) {
  const CameraModel camera{CameraConfig{}};
  constexpr double kHalf = 0.5 * kSizeM;
  const std::array<Eigen::Vector3d, 4> corners{
      Eigen::Vector3d{-kHalf, kHalf, 0}, Eigen::Vector3d{kHalf, kHalf, 0},
      Eigen::Vector3d{kHalf, -kHalf, 0}, Eigen::Vector3d{-kHalf, -kHalf, 0}};
  MeasuredCorners measured;
  for (std::size_t k = 0; k < 4; ++k) {
    measured.ideal_px[k] = camera.project(camera_from_marker * corners[k]);
    if (random != nullptr) {
      measured.ideal_px[k] +=
          Eigen::Vector2d{random->normal(0, sigma_px), random->normal(0, sigma_px)};
    }
  }
  measured.covariance *= sigma_px * sigma_px;
  measured.refined = true;
  return measured;
}

double angle_between(const Eigen::Isometry3d& a, const Eigen::Isometry3d& b) {
  return Eigen::Quaterniond{a.linear()}.angularDistance(Eigen::Quaterniond{b.linear()});
}

TEST(SquarePose, ExactCornersGiveTheExactPoseAndItsMirrorImage) {
  const Eigen::Isometry3d truth = turned_marker(radians(62));

  const auto poses =
      solve_square(corners_of(truth, 0.1, nullptr), CameraModel{CameraConfig{}}, kSizeM);

  ASSERT_TRUE(poses);
  EXPECT_LT((poses->best.camera_from_marker.translation() - truth.translation()).norm(), 1e-7);
  EXPECT_LT(angle_between(poses->best.camera_from_marker, truth), 1e-7);
  EXPECT_LT(poses->best.reprojection_error_px, 1e-6);
  EXPECT_GT(poses->other.reprojection_error_px, 0.5);
  EXPECT_NEAR(angle_between(poses->other.camera_from_marker, truth), radians(2 * 62), radians(25));
}

TEST(SquarePose, TheRightSolutionComesFirstAtCorridorAngles) {
  Random random{2};
  for (int i = 0; i < 200; ++i) {
    const Eigen::Isometry3d truth = turned_marker(radians(random.uniform(55, 75)));
    const auto poses =
        solve_square(corners_of(truth, 0.3, &random), CameraModel{CameraConfig{}}, kSizeM);
    ASSERT_TRUE(poses);
    EXPECT_LT(angle_between(poses->best.camera_from_marker, truth), radians(8));
    EXPECT_LE(poses->best.reprojection_error_px, poses->other.reprojection_error_px);
  }
}

TEST(SquarePose, InAFrontalViewTheErrorRatioShowsTheAmbiguity) {
  constexpr int kTrials = 100;
  const auto doubtful_at = [](double turn_rad) {
    Random random{3};
    int doubtful = 0;
    for (int i = 0; i < kTrials; ++i) {
      const auto poses = solve_square(corners_of(turned_marker(turn_rad), 0.4, &random),
                                      CameraModel{CameraConfig{}}, kSizeM);
      const bool is_doubtful =
          poses->other.reprojection_error_px < 2.0 * poses->best.reprojection_error_px;
      doubtful += is_doubtful ? 1 : 0;
    }
    return doubtful;
  };
  EXPECT_GT(doubtful_at(radians(3)), kTrials / 10);
  EXPECT_LT(doubtful_at(radians(60)), kTrials / 50);
}

/// Squared errors weighted by the stated covariance must average the number of dimensions, 6.
TEST(SquarePose, NeesEqualsTheDegreesOfFreedom) {
  constexpr int kTrials = 1000;
  Random random{4};
  const Eigen::Isometry3d truth = turned_marker(radians(62));
  double nees = 0.0;
  for (int i = 0; i < kTrials; ++i) {
    const auto poses =
        solve_square(corners_of(truth, 0.1, &random), CameraModel{CameraConfig{}}, kSizeM);
    ASSERT_TRUE(poses);
    const Eigen::AngleAxisd turn{poses->best.camera_from_marker.linear() *
                                 truth.linear().transpose()};
    Eigen::Matrix<double, 6, 1> error;
    error << poses->best.camera_from_marker.translation() - truth.translation(),
        turn.angle() * turn.axis();
    nees += error.dot(poses->covariance_in_camera.ldlt().solve(error)) / kTrials;
  }
  // Standard deviation of the mean of 1000 chi-squares of 6 dimensions: 0.11.
  EXPECT_NEAR(nees, 6.0, 0.5);
}

TEST(SquarePose, DegenerateCornersHaveNoPose) {
  MeasuredCorners corners;
  corners.ideal_px.fill({100.0, 100.0});
  EXPECT_FALSE(solve_square(corners, CameraModel{CameraConfig{}}, kSizeM));
}

}  // namespace
}  // namespace waymark
