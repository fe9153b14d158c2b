// SPDX-License-Identifier: BSD-3-Clause
// What the odometry gets wrong in the same way all the time, learnt while driving.
#pragma once

#include "slam/core/motion/motion.hpp"
#include "slam/core/proposal/pose_information.hpp"

#include <Eigen/Core>

namespace waymark {

class Fields;

/// Random walk of the odometry along the path, and how wrong its calibration may be (one sigma).
struct OdometryNoise {
  double along_per_sqrt_m{0.004};      ///< [m/sqrt(m)]
  double across_per_sqrt_m{0.001};     ///< [m/sqrt(m)] beyond what the heading explains
  double turn_per_sqrt_m{0.0087};      ///< [rad/sqrt(m)]
  double turn_per_sqrt_rad{0.02};      ///< [rad/sqrt(rad)]
  double scale_sigma{0.015};           ///< of distances
  double turn_scale_sigma{0.01};       ///< of turns
  double drift_sigma_rad_per_m{0.01};  ///< heading gained per metre

  void describe(Fields& fields);
};

/// Gaussian belief over scale of distances, heading drift per metre and scale of turns, exact for a
/// given path: Bayesian linear regression of true motions on measured ones.
class OdometryCalibration {
 public:
  explicit OdometryCalibration(const OdometryNoise& noise);

  /// The motion that is meant by a measured one.
  Se2 corrected(const Motion& motion) const;

  /// Covariance of (x, y, theta) at the end of a motion, in the frame at its start, for errors of
  /// the calibration and the random walk together.
  Eigen::Matrix3d covariance(const Motion& motion, const OdometryNoise& noise) const;

  /// Learns from the true motion behind a measured one.
  void learn(const Motion& measured, const Se2& true_start_from_end, const OdometryNoise& noise);

  double scale() const { return scale_; }

  double scale_variance() const { return 1.0 / scale_information_; }

  double drift_rad_per_m() const { return turning_.x(); }

  double turn_scale() const { return turning_.y(); }

 private:
  double scale_{0.0};  ///< true distance = (1 + scale) measured distance
  double scale_information_{0.0};
  Eigen::Vector2d turning_{Eigen::Vector2d::Zero()};  ///< drift [rad/m], scale of turns
  Eigen::Matrix2d turning_covariance_{Eigen::Matrix2d::Zero()};
};

}  // namespace waymark
