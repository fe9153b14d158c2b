// SPDX-License-Identifier: BSD-3-Clause
#include "common/geometry/chi2.hpp"

#include <Eigen/Cholesky>

namespace waymark {

double chi2(const Eigen::Vector3d& residual, const Eigen::Matrix3d& covariance) {
  return residual.dot(covariance.ldlt().solve(residual));
}

}  // namespace waymark
