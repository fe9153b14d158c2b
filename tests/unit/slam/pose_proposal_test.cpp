// SPDX-License-Identifier: BSD-3-Clause
// Unit tests of how knowledge about a pose is put together.
#include "slam/core/proposal/pose_proposal.hpp"

#include "support/small_world.hpp"

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace waymark {
namespace {

using test::diagonal;

// One dimension is enough to integrate by hand: only x is uncertain.
TEST(PoseProposal, AgreesWithBruteForceIntegration) {
  const Se2 prior{1.0, 2.0, 0.1};
  const Eigen::Matrix3d prior_covariance = diagonal(0.05, 1e-4, 1e-4);
  constexpr double kMeasured = 1.08;
  constexpr double kVariance = 0.03 * 0.03;
  const PoseProposal proposal = propose(
      prior, prior_covariance, [&](const Se2& pose, const Eigen::Matrix3d& /*uncertainty*/) {
        PoseInformation information;
        const double residual = pose.x() - kMeasured;
        information.information(0, 0) = 1.0 / kVariance;
        information.gradient.x() = residual / kVariance;
        information.cost = 0.5 * residual * residual / kVariance;
        return information;
      });
  double mass = 0.0;
  double mean = 0.0;
  double square = 0.0;
  constexpr double kStep = 1e-4;
  for (double x = 0.5; x < 1.5; x += kStep) {
    const double density = std::exp(-0.5 * std::pow((x - prior.x()) / 0.05, 2)) /
                           (0.05 * std::sqrt(2.0 * std::numbers::pi)) *
                           std::exp(-0.5 * std::pow(x - kMeasured, 2) / kVariance);
    mass += kStep * density;
    mean += kStep * density * x;
    square += kStep * density * x * x;
  }
  mean /= mass;
  EXPECT_NEAR(proposal.mean.x(), mean, 1e-6);
  EXPECT_NEAR(proposal.covariance(0, 0), square / mass - mean * mean, 1e-8);
  EXPECT_NEAR(proposal.log_evidence, std::log(mass), 1e-6);
  EXPECT_NEAR(proposal.mean.y(), prior.y(), 1e-9);
}

/// Of two rows: y + 2 theta and y - theta.
PoseInformation of_two_walls() {
  PoseInformation measured;
  for (const Eigen::Vector3d& row :
       {Eigen::Vector3d{0.0, 1.0, 2.0}, Eigen::Vector3d{0.0, 1.0, -1.0}}) {
    measured.information += 100.0 * row * row.transpose();
    measured.gradient += 100.0 * 0.3 * row;
  }
  return measured;
}

TEST(PoseInformation, UncertainSurroundingsAddTheirCovariance) {
  const PoseInformation measured = of_two_walls();
  const Eigen::Matrix3d uncertainty = diagonal(0.5, 0.2, 0.1);
  const PoseInformation left = blurred(measured, uncertainty);
  const Eigen::Matrix2d expected = (measured.information.bottomRightCorner<2, 2>().inverse() +
                                    uncertainty.bottomRightCorner<2, 2>())
                                       .inverse();
  EXPECT_TRUE((left.information.bottomRightCorner<2, 2>().isApprox(expected, 1e-9)));
  EXPECT_TRUE(left.information.row(0).isZero(1e-9)) << "what was not told is not told now";
  const Eigen::Vector2d best =
      -measured.information.bottomRightCorner<2, 2>().inverse() * measured.gradient.tail<2>();
  EXPECT_TRUE(
      (left.information.bottomRightCorner<2, 2>() * best).isApprox(-left.gradient.tail<2>()))
      << "the best pose is the same";
}

TEST(PoseInformation, CertainSurroundingsChangeNothing) {
  const PoseInformation measured = of_two_walls();
  const PoseInformation left = blurred(measured, Eigen::Matrix3d::Zero());
  EXPECT_TRUE(left.information.isApprox(measured.information));
  EXPECT_TRUE(left.gradient.isApprox(measured.gradient));
  EXPECT_TRUE(share_left(measured, Eigen::Matrix3d::Zero()).isIdentity());
}

}  // namespace
}  // namespace waymark
