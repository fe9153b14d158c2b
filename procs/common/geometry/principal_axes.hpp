// SPDX-License-Identifier: BSD-3-Clause
// Eigenvalues of 2 x 2 matrices, in a file of their own because Eigen's solver takes seconds to
// compile.
#pragma once

#include <Eigen/Core>

namespace waymark {

struct PrincipalAxes {
  Eigen::Vector2d values{};      ///< eigenvalues, ascending
  Eigen::Matrix2d directions{};  ///< columns: their unit eigenvectors
};

/// @param symmetric  only its lower triangle is read.
PrincipalAxes principal_axes(const Eigen::Matrix2d& symmetric);

}  // namespace waymark
