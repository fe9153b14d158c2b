// SPDX-License-Identifier: BSD-3-Clause
// How much worse the odometry is than its configuration says, found out while driving.
#pragma once

#include "slam/core/belief/odometry_errors.hpp"

#include <Eigen/Core>

namespace waymark {

/// What an update made of the pose that odometry had predicted, base frame (x, y, theta).
struct PoseCorrection {
  Eigen::Vector3d by{Eigen::Vector3d::Zero()};              ///< posterior mean minus prior mean
  Eigen::Vector3d prior_variance{Eigen::Vector3d::Zero()};  ///< of each axis
  Eigen::Vector3d posterior_variance{Eigen::Vector3d::Zero()};
};

/// Factors on the variances of the odometry's random walk. Squared corrections should on average be
/// what the variance loses by them; where they are larger, the random walk is, too. Wheels that
/// slip and carpets that pull are so learnt, and forgotten. The configured noise is the least.
/// Source: innovation-based adaptive estimation, Mehra (1972), "Approaches to adaptive filtering".
class NoiseGrowth {
 public:
  /// Axes that the update told little about are left alone.
  void learn(const PoseCorrection& correction);

  /// `noise` as large as it seems to be.
  OdometryNoise applied_to(OdometryNoise noise) const;

  /// Variances of (along, across, turn).
  const Eigen::Vector3d& factors() const { return factors_; }

 private:
  Eigen::Vector3d factors_{Eigen::Vector3d::Ones()};
};

}  // namespace waymark
