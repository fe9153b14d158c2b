// SPDX-License-Identifier: BSD-3-Clause
// Eigenvalues and eigenvectors of 2 x 2 matrices.
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
