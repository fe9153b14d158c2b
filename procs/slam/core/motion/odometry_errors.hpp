// SPDX-License-Identifier: BSD-3-Clause
// Errors of the odometry: a random walk, and systematic errors.
#pragma once

#include "slam/core/motion/motion.hpp"

#include <Eigen/Core>

namespace waymark {

class Fields;

/// Random walk of the odometry along the path, and standard deviations of its calibration.
struct OdometryNoise {
  double along_per_sqrt_m{0.003};
  double across_per_sqrt_m{0.001};
  double turn_per_sqrt_m{0.0087};
  double turn_per_sqrt_rad{0.02};
  double scale_sigma{0.02};
  double turn_scale_sigma{0.02};
  double drift_sigma_rad_per_m{0.01};
  double lidar_ahead_sigma_m{0.05};
  double lidar_yaw_sigma_rad{0.01};
  double half_track_m{0.14};  ///< half of the distance between the wheels; from the robot's file
  bool may_slip{true};

  /// Names, units and explanations of the keys: core_fields.cpp.
  void describe(Fields& fields);
};

/// Variance of the heading's random walk [rad^2] over `distance_m` of driving and turns of
/// `turn_rad`.
double turn_variance(const OdometryNoise& noise, double distance_m, double turn_rad);

/// Covariance of (x, y, theta) that the random walk adds while the robot drives straight ahead, in
/// the frame at the start; zero without motion.
Eigen::Matrix3d random_walk(double distance_m, double turn_rad, const OdometryNoise& noise);

/// That covariance for any motion; with a floor on the variances, also without motion.
Eigen::Matrix3d random_walk(const Motion& motion, const OdometryNoise& noise);

/// Systematic errors of odometry and of the LiDAR's mounting:
/// - kScale: true distance = (1 + scale) measured distance.
/// - kDrift [rad/m], kTurnScale: true turn = measured turn + drift * advance + turn scale * t;
///   t is the part of the measured turn that exceeds its noise.
/// - kLidarAhead [m], kLidarYaw [rad, left]: errors of the mounting. The first displaces the LiDAR
///   in turns on the spot, the second makes straight drives seem to drift sideways.
struct OdometryTerm {
  enum Index : Eigen::Index { kScale, kDrift, kTurnScale, kLidarAhead, kLidarYaw, kCount };
};

inline constexpr Eigen::Index kOdometryTerms = OdometryTerm::kCount;
using OdometryErrors = Eigen::Matrix<double, kOdometryTerms, 1>;

/// d(x, y, theta) / d(systematic errors).
using OdometryJacobian = Eigen::Matrix<double, 3, kOdometryTerms>;

/// A measured motion, corrected for systematic errors.
struct CorrectedMotion {
  Se2 start_from_end{};
  /// Jacobian of the pose at the end, in the frame at the start.
  OdometryJacobian jacobian_calibration{OdometryJacobian::Zero()};
  /// Covariance of (x, y, theta) in the frame at the start, from the random walk and guessed steps.
  Eigen::Matrix3d covariance{Eigen::Matrix3d::Zero()};
};

CorrectedMotion corrected_motion(const Motion& measured, const OdometryErrors& errors,
                                 const OdometryNoise& noise);

}  // namespace waymark
