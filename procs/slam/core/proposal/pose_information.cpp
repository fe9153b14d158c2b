// SPDX-License-Identifier: BSD-3-Clause
#include "slam/core/proposal/pose_information.hpp"

#include <Eigen/Eigenvalues>

namespace waymark {

Eigen::Matrix3d positive_part(const Eigen::Matrix3d& symmetric) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes{symmetric};
  return axes.eigenvectors() * axes.eigenvalues().cwiseMax(0.0).asDiagonal() *
         axes.eigenvectors().transpose();
}

}  // namespace waymark
