// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <Eigen/LU>

namespace waymark {

/// Information matrix of a measurement whose covariance grows by `noise`: (I + information
/// noise)^-1 information. The information may be singular.
inline Eigen::Matrix3d with_more_noise(const Eigen::Matrix3d& information,
                                       const Eigen::Matrix3d& noise) {
  if (noise.isZero(0.0)) return information;
  const Eigen::Matrix3d reduced =
      (Eigen::Matrix3d::Identity() + information * noise).inverse() * information;
  return 0.5 * (reduced + reduced.transpose());
}

}  // namespace waymark
