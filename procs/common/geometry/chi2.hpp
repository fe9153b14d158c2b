// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>

namespace waymark {

/// Squared distance in standard deviations (Mahalanobis).
/// @param covariance  of `off`; positive definite.
inline double chi2(const Eigen::Vector3d& off, const Eigen::Matrix3d& covariance) {
  return off.dot(covariance.ldlt().solve(off));
}

}  // namespace waymark
