// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

namespace waymark {

/// Gates: the 99.9 % quantiles of chi^2 with two and with three degrees of freedom.
inline constexpr double kChi2Gate2 = 13.8;
inline constexpr double kChi2Gate3 = 16.3;

/// Squared Mahalanobis distance: residual^T covariance^-1 residual.
/// @param covariance  positive definite.
double chi2(const Eigen::Vector3d& residual, const Eigen::Matrix3d& covariance);

}  // namespace waymark
