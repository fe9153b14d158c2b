// SPDX-License-Identifier: BSD-3-Clause
#include "slam/core/belief/pose_error.hpp"

namespace waymark {

Eigen::Matrix3d rest_of(const PoseError& error, const ErrorsCovariance& errors_covariance) {
  return error.covariance - error.by_errors * errors_covariance * error.by_errors.transpose();
}

PoseError with_rest(const Eigen::Matrix3d& rest, const PoseByErrors& by_errors,
                    const ErrorsCovariance& errors_covariance) {
  return {rest + by_errors * errors_covariance * by_errors.transpose(), by_errors};
}

PoseError sum_of(const PoseError& first, const PoseError& then,
                 const ErrorsCovariance& errors_covariance) {
  const Eigen::Matrix3d common = first.by_errors * errors_covariance * then.by_errors.transpose();
  return {first.covariance + then.covariance + common + common.transpose(),
          first.by_errors + then.by_errors};
}

}  // namespace waymark
