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
constexpr double kRollingPenalty = 0.1;      // 0.95
constexpr double kSlipPenalty = 7.0;         // 0.03, for each of left, right and both wheels
constexpr double kDisturbedPenalty = 8.4;    // 0.015
constexpr double kGrossErrorPenalty = 10.6;  // 0.005
// Widths, in standard deviations of the configured noise.
constexpr double kOneWheelSlip = 25.0;    // turn caused by a slipping wheel, and distance with it
constexpr double kOneWheelRest = 3.0;     // all other errors while one wheel slips
constexpr double kBothWheelsSlip = 25.0;  // of the distance alone
constexpr double kDisturbance = 25.0;
constexpr double kGrossErrorWidth = 125.0;
// Added to a gross error: a push, also while odometry stands still and its noise is almost zero.
constexpr double kPush_m = 0.1;
constexpr double kPush_rad = 0.1;

// Standard deviations of an unmeasured motion, per metre of standard deviation ahead.
constexpr double kSideways = 0.1;
constexpr double kTurn_rad_per_m = 0.2;

}  // namespace

double penalty(MotionKind kind) {
  if (kind == MotionKind::kRolling) return kRollingPenalty;
  if (kind == MotionKind::kDisturbed) return kDisturbedPenalty;
  return kind == MotionKind::kGrossError ? kGrossErrorPenalty : kSlipPenalty;
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

OdometryNoise scaled(OdometryNoise noise, const LearntOdometryNoise& learnt) {
  noise.along_per_sqrt_m *= learnt.along;
  noise.across_per_sqrt_m *= learnt.along;
  noise.turn_per_sqrt_m *= learnt.turn;
  noise.turn_per_sqrt_rad *= learnt.turn;
  return noise;
}

MotionKind likeliest_kind(const Eigen::Vector3d& residual, const MixtureNoise& noise) {
  // The other components are wider: only a smaller chi^2 can compensate for their penalty.
  const Eigen::LLT<Eigen::Matrix3d> rolling{noise.rolling};
  if (residual.dot(rolling.solve(residual)) <= kSlipPenalty - kRollingPenalty)
    return MotionKind::kRolling;
  const std::array<MotionKind, 4> kinds{
      MotionKind::kRolling, residual.z() > 0.0 ? MotionKind::kLeftSlips : MotionKind::kRightSlips,
      MotionKind::kDisturbed, MotionKind::kGrossError};
  return *std::min_element(kinds.begin(), kinds.end(), [&](MotionKind a, MotionKind b) {
    return mixture_cost(a, residual, noise) < mixture_cost(b, residual, noise);
  });
}

Eigen::Matrix3d covariance_of(MotionKind kind, const MixtureNoise& noise) {
  if (kind == MotionKind::kRolling) return noise.rolling;
  if (kind == MotionKind::kBothSlip) {
    const Eigen::Vector3d ahead{noise.ahead.x(), noise.ahead.y(), 0.0};
    const double along_m2 = ahead.dot(noise.described * ahead);
    return noise.rolling + squared(kBothWheelsSlip) * along_m2 * ahead * ahead.transpose();
  }
  if (kind == MotionKind::kDisturbed)
    return noise.rolling + squared(kDisturbance) * noise.described;
  if (kind == MotionKind::kGrossError) {
    const Eigen::Matrix3d pushed =
        Eigen::Vector3d{kPush_m, kPush_m, kPush_rad}.cwiseAbs2().asDiagonal();
    return noise.rolling + squared(kGrossErrorWidth) * noise.described + pushed;
  }
  // If only the left wheel spins by d, odometry reports the motion (d / 2, 0, -d / (2 half_track)):
  // x changes by -half_track per radian. For the right wheel, by +half_track.
  const bool is_left = kind == MotionKind::kLeftSlips;
  const Eigen::Vector3d slip{is_left ? -noise.half_track_m : noise.half_track_m, 0.0, 1.0};
  return noise.rolling + squared(kOneWheelRest) * noise.described +
         squared(kOneWheelSlip) * noise.described(2, 2) * slip * slip.transpose();
}

Eigen::Matrix3d unmeasured_covariance(double sigma_m) {
  return (sigma_m * Eigen::Vector3d{1.0, kSideways, kTurn_rad_per_m}).cwiseAbs2().asDiagonal();
}

double hidden_share(const Motion& motion, std::span<const Eigen::Matrix2d> places,
                    const LearntOdometryNoise& learnt) {
  const Se2& step = motion.start_from_end;
  if (step.translation().norm() == 0.0) return 0.0;
  const Eigen::Vector2d along = step.rotation().transpose() * step.translation().normalized();
  double information = 0.0;  // [1/m^2]
  for (const Eigen::Matrix2d& covariance : places)
    information += 1.0 / along.dot(covariance * along);
  return 1.0 / (1.0 + learnt.slip_m2 * information);
}

CorrectedMotion with_slips(CorrectedMotion moved, double distance_m, double share,
                           const LearntOdometryNoise& learnt) {
  const Eigen::Vector2d step = moved.start_from_end.translation();
  if (step.norm() == 0.0) return moved;
  const Eigen::Vector2d along = step.normalized();
  moved.start_from_end = {Eigen::Vector2d{step + share * learnt.slip_per_m * distance_m * along},
                          moved.start_from_end.theta()};
  moved.covariance.topLeftCorner<2, 2>() +=
      share * learnt.slip_m2_per_m * distance_m * along * along.transpose();
  return moved;
}

}  // namespace waymark
