// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

namespace waymark {

/// Squared Mahalanobis distance: residual^T covariance^-1 residual.
/// @param covariance  positive definite.
double chi2(const Eigen::Vector3d& residual, const Eigen::Matrix3d& covariance);

}  // namespace waymark
