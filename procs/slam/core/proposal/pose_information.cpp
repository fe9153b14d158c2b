// SPDX-License-Identifier: BSD-3-Clause
#include "slam/core/proposal/pose_information.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>

namespace waymark {

Eigen::Matrix3d without(const Eigen::Vector2d& direction) {
  Eigen::Matrix3d others = Eigen::Matrix3d::Identity();
  others.topLeftCorner<2, 2>() -= direction * direction.transpose();
  return others;
}

Eigen::Matrix3d positive_part(const Eigen::Matrix3d& symmetric) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes{symmetric};
  return axes.eigenvectors() * axes.eigenvalues().cwiseMax(0.0).asDiagonal() *
         axes.eigenvectors().transpose();
}

Eigen::Matrix3d share_left(const PoseInformation& measured, const Eigen::Matrix3d& uncertainty) {
  return (Eigen::Matrix3d::Identity() + measured.information * uncertainty).inverse();
}

PoseInformation blurred(const PoseInformation& measured, const Eigen::Matrix3d& uncertainty) {
  // (information^-1 + uncertainty)^-1, for any rank.
  const Eigen::Matrix3d share = share_left(measured, uncertainty);
  return {share * measured.information, share * measured.gradient, measured.cost};
}

}  // namespace waymark
