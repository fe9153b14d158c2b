// SPDX-License-Identifier: BSD-3-Clause
// What the odometry gets wrong: by chance at every step, and in the same way all the time.
#pragma once

#include "slam/core/motion/motion.hpp"

#include <Eigen/Core>

namespace waymark {

class Fields;

/// Random walk of the odometry along the path, and how wrong its calibration may be (one sigma).
struct OdometryNoise {
  double along_per_sqrt_m{0.003};
  double across_per_sqrt_m{0.001};
  double turn_per_sqrt_m{0.0087};
  double turn_per_sqrt_rad{0.02};
  double scale_sigma{0.02};
  double turn_scale_sigma{0.02};
  double drift_sigma_rad_per_m{0.01};
  double lidar_ahead_sigma_m{0.05};
  double half_track_m{0.14};  ///< between the wheels; taken from the robot
  bool may_slip{true};

  /// What they are, in words: core_fields.cpp.
  void describe(Fields& fields);
};

/// Variance of the heading's random walk [rad^2] on a way of `distance_m` with turns of `turn_rad`.
double turn_variance(const OdometryNoise& noise, double distance_m, double turn_rad);

/// Covariance of (x, y, theta) that the random walk adds on a way straight ahead, in the frame at
/// its start; zero where nothing was driven.
Eigen::Matrix3d random_walk(double distance_m, double turn_rad, const OdometryNoise& noise);

/// The same of any motion.
Eigen::Matrix3d random_walk(const Motion& motion, const OdometryNoise& noise);

/// Systematic errors, as a vector (scale, drift, turn scale, ahead): true distance = (1 + scale)
/// measured distance; true turn = (1 + turn scale) measured turn + drift [rad/m] * advance.
/// What the LiDAR localises is `ahead` [m] before what the wheels turn about, beyond its
/// configured place: a robot that turns on the spot moves it sideways.
using OdometryErrors = Eigen::Vector4d;
inline constexpr Eigen::Index kOdometryErrors = OdometryErrors::SizeAtCompileTime;

/// How (x, y, theta) follows the systematic errors.
using MotionByErrors = Eigen::Matrix<double, 3, kOdometryErrors>;

/// A measured motion, corrected by systematic errors.
struct CorrectedMotion {
  Se2 start_from_end{};
  /// Of (x, y, theta) at the end, in the frame at the start, by the systematic errors.
  MotionByErrors by_errors{MotionByErrors::Zero()};
  /// Of the random walk, same order and frame.
  Eigen::Matrix3d covariance{Eigen::Matrix3d::Zero()};
};

CorrectedMotion corrected_motion(const Motion& measured, const OdometryErrors& errors,
                                 const OdometryNoise& noise);

}  // namespace waymark
