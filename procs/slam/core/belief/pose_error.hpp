// SPDX-License-Identifier: BSD-3-Clause
// Errors of a pose that partly follow the systematic errors of the sensors.
#pragma once

#include "slam/core/belief/odometry_errors.hpp"

#include <Eigen/Core>

namespace waymark {

/// All systematic errors: those of the odometry, then those of sightings.
inline constexpr Eigen::Index kStaticErrors = kOdometryErrors + 3;
using StaticErrors = Eigen::Matrix<double, kStaticErrors, 1>;

using ErrorsCovariance = Eigen::Matrix<double, kStaticErrors, kStaticErrors>;

/// How (x, y, theta; map frame) follows the systematic errors.
using PoseByErrors = Eigen::Matrix<double, 3, kStaticErrors>;

/// An error of the pose (x, y, theta; map frame): its covariance, and how it follows the systematic
/// errors. What follows them is part of the covariance.
struct PoseError {
  Eigen::Matrix3d covariance{Eigen::Matrix3d::Zero()};
  PoseByErrors by_errors{PoseByErrors::Zero()};
};

/// The part of the covariance that does not follow the systematic errors.
Eigen::Matrix3d rest_of(const PoseError& error, const ErrorsCovariance& errors_covariance);

/// An error with that rest.
PoseError with_rest(const Eigen::Matrix3d& rest, const PoseByErrors& by_errors,
                    const ErrorsCovariance& errors_covariance);

/// Both, one on top of the other; their rests are independent.
PoseError sum_of(const PoseError& first, const PoseError& then,
                 const ErrorsCovariance& errors_covariance);

}  // namespace waymark
