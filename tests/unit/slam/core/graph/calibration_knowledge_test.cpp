// SPDX-License-Identifier: BSD-3-Clause
#include "slam/core/graph/calibration_knowledge.hpp"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

namespace waymark {
namespace {

/// A measurement by a wall that depends on the focal length alone.
WallInnovation focal_length_off_by(double error, double sigma) {
  WallInnovation wall;
  wall.residual << error, 0.0;
  wall.jacobian_camera(0, SightingNoise::kFocal) = 1.0;
  wall.jacobian_standoff.setZero();
  wall.covariance = Eigen::Vector2d{sigma * sigma, 1.0}.asDiagonal();
  return wall;
}

TEST(CalibrationKnowledge, MeasurementsOverruleADescriptionThatIsFarOff) {
  Calibration sigmas = Calibration::Constant(0.01);
  sigmas[kOdometryTerms + SightingNoise::kFocal] = 1e-4;
  CalibrationKnowledge knowledge{sigmas};
  constexpr double kTrue = 5e-3;
  constexpr double kMeasured = 2e-4;
  knowledge.observe(focal_length_off_by(kTrue, kMeasured));
  Calibration value = Calibration::Zero();
  Eigen::MatrixXd h;
  for (int i = 0; i < 3; ++i) {  // the prior's width follows the estimate
    h = Eigen::MatrixXd::Zero(kCalibrationSize, kCalibrationSize);
    Eigen::VectorXd g = Eigen::VectorXd::Zero(kCalibrationSize);
    knowledge.add_to(value, h, g);
    value -= h.ldlt().solve(g);
    knowledge.choose_prior_widths(value, h.inverse().diagonal());
  }
  const Eigen::Index focal = kOdometryTerms + SightingNoise::kFocal;
  EXPECT_NEAR(value[focal], kTrue, 3.0 * kMeasured);
  EXPECT_EQ(knowledge.doubted_terms(value), std::vector{static_cast<std::size_t>(focal)});
  EXPECT_NEAR(1.0 / std::sqrt(h(focal, focal)), kMeasured, 0.1 * kMeasured);
}

TEST(CalibrationKnowledge, AConsistentDescriptionKeepsItsWeight) {
  CalibrationKnowledge knowledge{Calibration::Constant(1e-3)};
  knowledge.observe(focal_length_off_by(1.5e-3, 1e-3));
  Calibration value = Calibration::Zero();
  for (int i = 0; i < 3; ++i) {
    Eigen::MatrixXd h = Eigen::MatrixXd::Zero(kCalibrationSize, kCalibrationSize);
    Eigen::VectorXd g = Eigen::VectorXd::Zero(kCalibrationSize);
    knowledge.add_to(value, h, g);
    value -= h.ldlt().solve(g);
    knowledge.choose_prior_widths(value, h.inverse().diagonal());
  }
  EXPECT_NEAR(value[kOdometryTerms + SightingNoise::kFocal], 0.75e-3, 1e-6);
  EXPECT_TRUE(knowledge.doubted_terms(value).empty());
}

/// Variances from a singular or indefinite matrix are not finite or not positive.
TEST(CalibrationKnowledge, ImpossibleVariancesLeaveThePriorAsItIs) {
  constexpr double kSigma = 1e-3;
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  constexpr double kInfinite = std::numeric_limits<double>::infinity();
  for (const double variance : {kNan, kInfinite, 0.0, -1e-9}) {
    for (const double estimate : {0.0, 2e-3, kNan}) {
      CalibrationKnowledge knowledge{Calibration::Constant(kSigma)};
      knowledge.choose_prior_widths(Calibration::Constant(estimate),
                                    Calibration::Constant(variance));
      Eigen::MatrixXd h = Eigen::MatrixXd::Zero(kCalibrationSize, kCalibrationSize);
      Eigen::VectorXd g = Eigen::VectorXd::Zero(kCalibrationSize);
      knowledge.add_to(Calibration::Zero(), h, g);
      for (Eigen::Index i = 0; i < kCalibrationSize; ++i)
        EXPECT_NEAR(h(i, i) * kSigma * kSigma, 1.0, 1e-9) << variance << ", term " << i;
    }
  }
}

}  // namespace
}  // namespace waymark
