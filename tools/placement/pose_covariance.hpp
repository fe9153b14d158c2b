// SPDX-License-Identifier: BSD-3-Clause
// The joint covariance of a drive's unknowns: calibration, the pose, some of the poses before, and
// landmarks. Linear, as the graph is about its solution; exact, for nothing is forgotten.
#pragma once

#include "common/geometry/se2.hpp"
#include "slam/core/graph/state.hpp"

#include <Eigen/Core>

#include <map>
#include <vector>

namespace waymark::placement {

/// Errors are additive (x, y, theta) in the map frame, as in the graph's State.
class PoseCovariance {
 public:
  /// @param calibration_sigmas  of the robot's description.
  /// @param pose_sigma          of the first pose [m, rad].
  PoseCovariance(const Calibration& calibration_sigmas, double pose_sigma);

  struct Block {
    Variable variable{};
    Eigen::MatrixXd jacobian{};
  };

  /// The pose now; its index is not used.
  static constexpr Variable kPose{VariableKind::kKeyframe, static_cast<std::size_t>(-1)};
  static constexpr Variable kCalibration{VariableKind::kCalibration, 0};

  bool has(const Variable& variable) const { return offsets_.contains(variable); }

  Eigen::Matrix3d of_pose() const { return p_.block<3, 3>(kPoseAt, kPoseAt); }

  /// pose = jacobian_pose * pose + jacobian_calibration * calibration + noise.
  void move(const Eigen::Matrix3d& jacobian_pose,
            const Eigen::Matrix<double, 3, kCalibrationSize>& jacobian_calibration,
            const Eigen::Matrix3d& noise);

  /// A new variable = sum of jacobian * variable + noise.
  void add(const Variable& variable, const std::vector<Block>& of, const Eigen::Matrix3d& noise);

  void drop(const Variable& variable);

  /// A measurement whitened to unit covariance: sum of jacobian * variable.
  void measure(const std::vector<Block>& blocks);

 private:
  static constexpr Eigen::Index kPoseAt = kCalibrationSize;

  Eigen::MatrixXd columns_of(const std::vector<Block>& blocks) const;

  std::map<Variable, Eigen::Index> offsets_{};
  Eigen::MatrixXd p_;
};

}  // namespace waymark::placement
