// SPDX-License-Identifier: BSD-3-Clause
#include "slam/core/motion/odometry_errors.hpp"

#include "common/geometry/squared.hpp"

#include <algorithm>
#include <cmath>

namespace waymark {
namespace {

// A turn of fewer standard deviations of its noise does not observe the scale of turns.
constexpr double kSignificantSigmas = 3.0;
constexpr double kGuessed_m_s = 0.25;    // sigma of a guessed speed; in rad/s that of turning
constexpr double kVarianceFloor = 1e-9;  // [m^2, rad^2] of a step: 0.03 mm, 0.002 degrees

/// A measured turn that is mostly noise would bias the estimated scale below one (regression
/// dilution): only the share of the turn that exceeds the noise is multiplied by the scale.
double significant_turn(double turn_rad, double noise_rad2) {
  const double share = 1.0 - squared(kSignificantSigmas) * noise_rad2 / squared(turn_rad);
  return turn_rad != 0.0 ? std::max(0.0, share) * turn_rad : 0.0;
}

}  // namespace

double turn_variance(const OdometryNoise& noise, double distance_m, double turn_rad) {
  return squared(noise.turn_per_sqrt_m) * distance_m + squared(noise.turn_per_sqrt_rad) * turn_rad;
}

Eigen::Matrix3d random_walk(const Motion& motion, const OdometryNoise& noise) {
  const double length_m = motion.start_from_end.translation().norm();
  const Eigen::Vector2d along =
      length_m > 0.0 ? Eigen::Vector2d{motion.start_from_end.translation() / length_m}
                     : Eigen::Vector2d::UnitX();
  const Eigen::Vector2d left{-along.y(), along.x()};
  const double turn_rad2 =
      turn_variance(noise, motion.distance_m, motion.turn_rad) + kVarianceFloor;
  // The wheels also roll while the robot turns on the spot.
  const double rolled_m = std::max(motion.distance_m, noise.half_track_m * motion.turn_rad);
  const double along_m2 = squared(noise.along_per_sqrt_m) * rolled_m + kVarianceFloor;
  // Integrated random walk of the heading over a length L: the lateral variance is L^2 / 3 times
  // the final heading's variance, their covariance L / 2 times that.
  const double across_m2 = squared(length_m) * turn_rad2 / 3.0 +
                           squared(noise.across_per_sqrt_m) * rolled_m + kVarianceFloor;
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  covariance.topLeftCorner<2, 2>() =
      along_m2 * along * along.transpose() + across_m2 * left * left.transpose();
  covariance(2, 2) = turn_rad2;
  covariance.topRightCorner<2, 1>() = 0.5 * length_m * turn_rad2 * left;
  covariance.bottomLeftCorner<1, 2>() = covariance.topRightCorner<2, 1>().transpose();
  return covariance;
}

Eigen::Matrix3d random_walk(double distance_m, double turn_rad, const OdometryNoise& noise) {
  if (distance_m == 0.0 && turn_rad == 0.0) return Eigen::Matrix3d::Zero();
  return random_walk({{distance_m, 0.0, 0.0}, distance_m, turn_rad}, noise);
}

CorrectedMotion corrected_motion(const Motion& measured, const OdometryErrors& errors,
                                 const OdometryNoise& noise) {
  const double turn_rad = measured.start_from_end.theta();
  const double significant_rad = significant_turn(turn_rad, random_walk(measured, noise)(2, 2));
  const double extra_rad = errors[OdometryTerm::kDrift] * measured.advance_m +
                           errors[OdometryTerm::kTurnScale] * significant_rad;
  // A heading error that grows evenly along the path turns the displacement by half of it.
  const Eigen::Vector2d bent =
      Se2{0.0, 0.0, 0.5 * extra_rad} * measured.start_from_end.translation();
  // The LiDAR's pose after the motion, in its pose before: m^-1 B m, with the motion B of the base
  // and the LiDAR's mounting m; for the position, m^-1 B m = R(-yaw) (B + (R(turn) - I) (ahead,
  // 0)).
  const Eigen::Matrix2d to_lidar = Se2{0.0, 0.0, -errors[OdometryTerm::kLidarYaw]}.rotation();
  const Eigen::Vector2d swing =
      to_lidar * Eigen::Vector2d{std::cos(significant_rad) - 1.0, std::sin(significant_rad)};
  const Eigen::Vector2d driven = to_lidar * bent;
  const Eigen::Vector2d advanced = (1.0 + errors[OdometryTerm::kScale]) * driven;
  const Eigen::Vector2d moved = advanced + errors[OdometryTerm::kLidarAhead] * swing;
  CorrectedMotion corrected;
  corrected.start_from_end = {moved, turn_rad + extra_rad};
  const Eigen::Vector3d jacobian_turn{-0.5 * advanced.y(), 0.5 * advanced.x(), 1.0};
  OdometryJacobian& jacobian = corrected.jacobian_calibration;
  jacobian.col(OdometryTerm::kScale) << driven, 0.0;
  jacobian.col(OdometryTerm::kDrift) = measured.advance_m * jacobian_turn;
  jacobian.col(OdometryTerm::kTurnScale) = significant_rad * jacobian_turn;
  jacobian.col(OdometryTerm::kLidarAhead) << swing, 0.0;
  jacobian.col(OdometryTerm::kLidarYaw) << moved.y(), -moved.x(), 0.0;
  corrected.covariance =
      random_walk(measured, noise) +
      Eigen::Matrix3d{Eigen::Matrix3d::Identity() * squared(kGuessed_m_s * measured.guessed_s)};
  return corrected;
}

}  // namespace waymark
