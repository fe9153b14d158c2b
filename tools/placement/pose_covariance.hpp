// SPDX-License-Identifier: BSD-3-Clause
// Joint covariance of calibration, current pose, some past poses and landmarks during a drive: a
// linear Kalman filter over the graph's linearised factors. Exact, as all correlations are kept.
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
  /// @param calibration_sigmas  prior sigmas of the calibration, units as in Calibration.
  /// @param pose_sigma          of the first pose, x, y [m] and theta [rad].
  PoseCovariance(const Calibration& calibration_sigmas, double pose_sigma);

  struct Block {
    Variable variable{};
    Eigen::MatrixXd jacobian{};
  };

  /// The current pose; its index is not used.
  static constexpr Variable kPose{VariableKind::kKeyframe, static_cast<std::size_t>(-1)};
  static constexpr Variable kCalibration{VariableKind::kCalibration, 0};

  bool has(const Variable& variable) const { return offsets_.contains(variable); }

  Eigen::Matrix3d of_pose() const { return p_.block<3, 3>(kPoseAt, kPoseAt); }

  /// Prediction: pose = jacobian_pose * pose + jacobian_calibration * calibration + noise.
  void move(const Eigen::Matrix3d& jacobian_pose,
            const Eigen::Matrix<double, 3, kCalibrationSize>& jacobian_calibration,
            const Eigen::Matrix3d& noise);

  /// Adds a new variable = sum of jacobian * variable + noise.
  void add(const Variable& variable, const std::vector<Block>& of, const Eigen::Matrix3d& noise);

  void drop(const Variable& variable);

  /// Update with a measurement of the sum of jacobian * variable, whitened to unit covariance.
  void measure(const std::vector<Block>& blocks);

 private:
  static constexpr Eigen::Index kPoseAt = kCalibrationSize;

  Eigen::MatrixXd columns_of(const std::vector<Block>& blocks) const;

  std::map<Variable, Eigen::Index> offsets_{};
  Eigen::MatrixXd p_;
};

}  // namespace waymark::placement
