// SPDX-License-Identifier: BSD-3-Clause
#include "slam/core/calibration/odometry_calibration.hpp"

#include <algorithm>

namespace waymark {
namespace {

constexpr double kVarianceFloor = 1e-9;  // [m^2, rad^2] of a step: 0.03 mm, 0.002 degrees

double squared(double x) {
  return x * x;
}

double walk_of_heading(const Motion& motion, const OdometryNoise& noise) {
  return squared(noise.turn_per_sqrt_m) * motion.distance_m +
         squared(noise.turn_per_sqrt_rad) * motion.turn_rad + kVarianceFloor;
}

double walk_along(const Motion& motion, const OdometryNoise& noise) {
  return squared(noise.along_per_sqrt_m) * motion.distance_m + kVarianceFloor;
}

Eigen::Vector2d turning_regressors(const Motion& motion) {
  return {motion.distance_m, motion.start_from_end.theta()};
}

Eigen::Vector2d direction_of(const Motion& motion) {
  const double length_m = motion.start_from_end.translation().norm();
  return length_m > 0.0 ? Eigen::Vector2d{motion.start_from_end.translation() / length_m}
                        : Eigen::Vector2d{1.0, 0.0};
}

}  // namespace

OdometryCalibration::OdometryCalibration(const OdometryNoise& noise)
    : scale_information_{1.0 / std::max(squared(noise.scale_sigma), kVarianceFloor)} {
  turning_covariance_(0, 0) = squared(noise.drift_sigma_rad_per_m);
  turning_covariance_(1, 1) = squared(noise.turn_scale_sigma);
}

Se2 OdometryCalibration::corrected(const Motion& motion) const {
  const double turn_rad = turning_.dot(turning_regressors(motion));
  // A turn that grows evenly along the way bends the path by half of it.
  const Se2 half{0.0, 0.0, 0.5 * turn_rad};
  return {half.rotation() * motion.start_from_end.translation() * (1.0 + scale_),
          motion.start_from_end.theta() + turn_rad};
}

Eigen::Matrix3d OdometryCalibration::covariance(const Motion& motion,
                                                const OdometryNoise& noise) const {
  const Eigen::Vector2d along = direction_of(motion);
  const Eigen::Vector2d left{-along.y(), along.x()};
  const double length_m = motion.start_from_end.translation().norm();
  const Eigen::Vector2d regressors = turning_regressors(motion);
  const double systematic_rad2 = regressors.dot(turning_covariance_ * regressors);
  const double walk_rad2 = walk_of_heading(motion, noise);
  const double along_m2 = walk_along(motion, noise) + squared(length_m) * scale_variance();
  // Integrated random walk: L^2 / 3 of the final heading's variance, L / 2 in common with it.
  const double across_m2 = squared(length_m) * (walk_rad2 / 3.0 + systematic_rad2 / 4.0) +
                           squared(noise.across_per_sqrt_m) * motion.distance_m + kVarianceFloor;
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  covariance.topLeftCorner<2, 2>() =
      along_m2 * along * along.transpose() + across_m2 * left * left.transpose();
  covariance(2, 2) = walk_rad2 + systematic_rad2;
  covariance.topRightCorner<2, 1>() = 0.5 * length_m * covariance(2, 2) * left;
  covariance.bottomLeftCorner<1, 2>() = covariance.topRightCorner<2, 1>().transpose();
  return covariance;
}

void OdometryCalibration::learn(const Motion& measured, const Se2& true_start_from_end,
                                const OdometryNoise& noise) {
  const Eigen::Vector2d along = direction_of(measured);
  const double length_m = measured.start_from_end.translation().norm();
  const double excess_m = along.dot(true_start_from_end.translation()) - length_m;
  const double along_m2 = walk_along(measured, noise);
  const double information = squared(length_m) / along_m2;
  scale_ = (scale_information_ * scale_ + length_m * excess_m / along_m2) /
           (scale_information_ + information);
  scale_information_ += information;

  const Eigen::Vector2d regressors = turning_regressors(measured);
  const double excess_rad =
      angle_difference(true_start_from_end.theta(), measured.start_from_end.theta());
  const Eigen::Vector2d spread = turning_covariance_ * regressors;
  const double innovation_rad2 = regressors.dot(spread) + walk_of_heading(measured, noise);
  turning_ += spread * (excess_rad - turning_.dot(regressors)) / innovation_rad2;
  turning_covariance_ -= spread * spread.transpose() / innovation_rad2;
}

}  // namespace waymark
