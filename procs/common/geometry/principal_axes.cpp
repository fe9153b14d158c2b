// SPDX-License-Identifier: BSD-3-Clause
#include "common/geometry/principal_axes.hpp"

#include <Eigen/Eigenvalues>

namespace waymark {

PrincipalAxes principal_axes(const Eigen::Matrix2d& symmetric) {
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> solver;
  solver.computeDirect(symmetric);
  return {solver.eigenvalues(), solver.eigenvectors()};
}

}  // namespace waymark
