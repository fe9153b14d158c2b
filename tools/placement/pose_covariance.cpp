// SPDX-License-Identifier: BSD-3-Clause
#include "placement/pose_covariance.hpp"

#include <Eigen/Cholesky>

#include <algorithm>

namespace waymark::placement {

PoseCovariance::PoseCovariance(const Calibration& calibration_sigmas, double pose_sigma)
    : offsets_{{kCalibration, 0}, {kPose, kPoseAt}},
      p_{Eigen::MatrixXd::Zero(kPoseAt + 3, kPoseAt + 3)} {
  p_.diagonal().head<kCalibrationSize>() = calibration_sigmas.cwiseAbs2();
  p_.diagonal().tail<3>().setConstant(pose_sigma * pose_sigma);
}

void PoseCovariance::move(const Eigen::Matrix3d& jacobian_pose,
                          const Eigen::Matrix<double, 3, kCalibrationSize>& jacobian_calibration,
                          const Eigen::Matrix3d& noise) {
  const Eigen::MatrixXd rows = jacobian_pose * p_.middleRows<3>(kPoseAt) +
                               jacobian_calibration * p_.topRows<kCalibrationSize>();
  const Eigen::Matrix3d own = rows.middleCols<3>(kPoseAt) * jacobian_pose.transpose() +
                              rows.leftCols<kCalibrationSize>() * jacobian_calibration.transpose() +
                              noise;
  p_.middleRows<3>(kPoseAt) = rows;
  p_.middleCols<3>(kPoseAt) = rows.transpose();
  p_.block<3, 3>(kPoseAt, kPoseAt) = 0.5 * (own + own.transpose());
}

/// Covariance of all variables with the sum of jacobian * variable over `blocks`.
Eigen::MatrixXd PoseCovariance::columns_of(const std::vector<Block>& blocks) const {
  Eigen::MatrixXd columns = Eigen::MatrixXd::Zero(p_.rows(), blocks.front().jacobian.rows());
  for (const Block& block : blocks) {
    columns.noalias() += p_.middleCols(offsets_.at(block.variable), block.jacobian.cols()) *
                         block.jacobian.transpose();
  }
  return columns;
}

void PoseCovariance::add(const Variable& variable, const std::vector<Block>& of,
                         const Eigen::Matrix3d& noise) {
  const Eigen::MatrixXd columns = columns_of(of);
  Eigen::Matrix3d own = noise;
  for (const Block& block : of)
    own += block.jacobian * columns.middleRows(offsets_.at(block.variable), block.jacobian.cols());
  const Eigen::Index at = p_.rows();
  p_.conservativeResize(at + 3, at + 3);
  p_.topRightCorner(at, 3) = columns;
  p_.bottomLeftCorner(3, at) = columns.transpose();
  p_.bottomRightCorner<3, 3>() = 0.5 * (own + own.transpose());
  offsets_[variable] = at;
}

/// The last variable is moved to the free rows and columns.
void PoseCovariance::drop(const Variable& variable) {
  const Eigen::Index at = offsets_.at(variable);
  const Eigen::Index last = p_.rows() - 3;
  offsets_.erase(variable);
  if (at != last) {
    p_.middleRows<3>(at) = p_.bottomRows<3>().eval();
    p_.middleCols<3>(at) = p_.rightCols<3>().eval();
    const auto moved = std::find_if(offsets_.begin(), offsets_.end(),
                                    [last](const auto& entry) { return entry.second == last; });
    moved->second = at;
  }
  p_.conservativeResize(last, last);
}

void PoseCovariance::measure(const std::vector<Block>& blocks) {
  const Eigen::MatrixXd columns = columns_of(blocks);
  const Eigen::Index size = columns.cols();
  Eigen::MatrixXd innovation = Eigen::MatrixXd::Identity(size, size);
  for (const Block& block : blocks) {
    innovation.noalias() +=
        block.jacobian * columns.middleRows(offsets_.at(block.variable), block.jacobian.cols());
  }
  const Eigen::LLT<Eigen::MatrixXd> root{innovation};
  const Eigen::MatrixXd gain = root.matrixL().solve(columns.transpose());
  p_.noalias() -= gain.transpose() * gain;
}

}  // namespace waymark::placement
