// SPDX-License-Identifier: BSD-3-Clause
#include "slam/core/motion/odometry_mixture.hpp"

#include "common/geometry/squared.hpp"

#include <Eigen/Cholesky>

#include <algorithm>
#include <array>

namespace waymark {
namespace {

// The mixture of the odometry's noise; all constants were chosen, not fitted.
// Penalties: -2 log of the prior probabilities of the components, rounded.
constexpr double kRollingPenalty = 0.1;    // 0.95
constexpr double kSpinningPenalty = 7.0;   // 0.03, each of left, right and both wheels
constexpr double kJerkedPenalty = 8.4;     // 0.015
constexpr double kAnythingPenalty = 10.6;  // 0.005
// Widths, in standard deviations of the configured noise.
constexpr double kSpinningTurn = 25.0;  // turn caused by a spinning wheel, and distance with it
constexpr double kSpinningRest = 3.0;   // all other errors while a wheel spins
constexpr double kSlipping = 25.0;      // distance alone
constexpr double kJerked = 25.0;
constexpr double kAnything = 125.0;
// A push, also while the odometry stands still and its configured noise is almost zero.
constexpr double kPushed_m = 0.1;
constexpr double kPushed_rad = 0.1;

// Standard deviations of an unmeasured motion, per metre of standard deviation ahead.
constexpr double kSideways = 0.1;
constexpr double kTurn_rad_per_m = 0.2;

}  // namespace

double penalty(MotionKind kind) {
  if (kind == MotionKind::kRolling) return kRollingPenalty;
  if (kind == MotionKind::kJerked) return kJerkedPenalty;
  return kind == MotionKind::kAnything ? kAnythingPenalty : kSpinningPenalty;
}

double cost_at_zero(MotionKind kind, const Eigen::LLT<Eigen::Matrix3d>& root) {
  const double log_determinant =
      2.0 * Eigen::Matrix3d{root.matrixL()}.diagonal().array().log().sum();
  return penalty(kind) + log_determinant;
}

double mixture_cost(MotionKind kind, const Eigen::Vector3d& residual, const MixtureNoise& noise) {
  const Eigen::LLT<Eigen::Matrix3d> root{covariance_of(kind, noise)};
  return residual.dot(root.solve(residual)) + cost_at_zero(kind, root);
}

OdometryNoise scaled(OdometryNoise noise, const OdometryScale& scale) {
  noise.along_per_sqrt_m *= scale.along;
  noise.across_per_sqrt_m *= scale.along;
  noise.turn_per_sqrt_m *= scale.turn;
  noise.turn_per_sqrt_rad *= scale.turn;
  return noise;
}

MotionKind likeliest_kind(const Eigen::Vector3d& residual, const MixtureNoise& noise) {
  // The other components are wider: only a smaller chi^2 can compensate for their penalty.
  const Eigen::LLT<Eigen::Matrix3d> rolling{noise.rolling};
  if (residual.dot(rolling.solve(residual)) <= kSpinningPenalty - kRollingPenalty)
    return MotionKind::kRolling;
  const std::array<MotionKind, 4> kinds{
      MotionKind::kRolling, residual.z() > 0.0 ? MotionKind::kLeftSpins : MotionKind::kRightSpins,
      MotionKind::kJerked, MotionKind::kAnything};
  return *std::min_element(kinds.begin(), kinds.end(), [&](MotionKind a, MotionKind b) {
    return mixture_cost(a, residual, noise) < mixture_cost(b, residual, noise);
  });
}

Eigen::Matrix3d covariance_of(MotionKind kind, const MixtureNoise& noise) {
  if (kind == MotionKind::kRolling) return noise.rolling;
  if (kind == MotionKind::kSlipping) {
    const Eigen::Vector3d ahead{noise.ahead.x(), noise.ahead.y(), 0.0};
    const double along_m2 = ahead.dot(noise.described * ahead);
    return noise.rolling + squared(kSlipping) * along_m2 * ahead * ahead.transpose();
  }
  if (kind == MotionKind::kJerked) return noise.rolling + squared(kJerked) * noise.described;
  if (kind == MotionKind::kAnything) {
    const Eigen::Matrix3d pushed =
        Eigen::Vector3d{kPushed_m, kPushed_m, kPushed_rad}.cwiseAbs2().asDiagonal();
    return noise.rolling + squared(kAnything) * noise.described + pushed;
  }
  // The encoder of a spinning wheel overcounts: d(x, y)/d(theta) = (-half_track, 0) of the left
  // wheel, (half_track, 0) of the right one.
  const bool is_left = kind == MotionKind::kLeftSpins;
  const Eigen::Vector3d spin{is_left ? -noise.half_track_m : noise.half_track_m, 0.0, 1.0};
  return noise.rolling + squared(kSpinningRest) * noise.described +
         squared(kSpinningTurn) * noise.described(2, 2) * spin * spin.transpose();
}

Eigen::Matrix3d unmeasured_covariance(double sigma_m) {
  return (sigma_m * Eigen::Vector3d{1.0, kSideways, kTurn_rad_per_m}).cwiseAbs2().asDiagonal();
}

double hidden_share(const Motion& motion, std::span<const Eigen::Matrix2d> places,
                    const OdometryScale& scale) {
  const Se2& step = motion.start_from_end;
  if (step.translation().norm() == 0.0) return 0.0;
  const Eigen::Vector2d along = step.rotation().transpose() * step.translation().normalized();
  double information = 0.0;  // [1/m^2]
  for (const Eigen::Matrix2d& covariance : places)
    information += 1.0 / along.dot(covariance * along);
  return 1.0 / (1.0 + scale.slip_m2 * information);
}

CorrectedMotion with_slips(CorrectedMotion moved, double distance_m, double share,
                           const OdometryScale& scale) {
  const Eigen::Vector2d step = moved.start_from_end.translation();
  if (step.norm() == 0.0) return moved;
  const Eigen::Vector2d along = step.normalized();
  moved.start_from_end = {Eigen::Vector2d{step + share * scale.slip_per_m * distance_m * along},
                          moved.start_from_end.theta()};
  moved.covariance.topLeftCorner<2, 2>() +=
      share * scale.slip_m2_per_m * distance_m * along * along.transpose();
  return moved;
}

}  // namespace waymark
