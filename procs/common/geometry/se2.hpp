// SPDX-License-Identifier: BSD-3-Clause
// Rigid motions of the plane. Matrix products are in se2.cpp: Eigen's templates would cost every
// file that includes this 0.8 s of compile time.
#pragma once

#include "common/geometry/angle.hpp"

#include <Eigen/Core>

namespace waymark {

/// A pose in the plane, read as `parent_from_child`: it maps child coordinates to parent
/// coordinates.
class Se2 {
 public:
  Se2() = default;

  Se2(double x_m, double y_m, double theta_rad)
      : translation_{x_m, y_m}, theta_rad_{wrap_angle(theta_rad)} {}

  Se2(const Eigen::Vector2d& translation_m, double theta_rad)
      : translation_{translation_m}, theta_rad_{wrap_angle(theta_rad)} {}

  double x() const { return translation_.x(); }

  double y() const { return translation_.y(); }

  /// Heading [rad] in (-pi, pi].
  double theta() const { return theta_rad_; }

  const Eigen::Vector2d& translation() const { return translation_; }

  Eigen::Matrix2d rotation() const;
  Se2 inverse() const;
  Se2 operator*(const Se2& child) const;
  Eigen::Vector2d operator*(const Eigen::Vector2d& point_in_child) const;

 private:
  Eigen::Vector2d translation_{Eigen::Vector2d::Zero()};
  double theta_rad_{0.0};
};

/// Pose between two poses: `from` at fraction 0, `to` at 1; the heading changes the short way.
Se2 interpolate(const Se2& from, const Se2& to, double fraction);

/// (x, y, theta) of one pose minus those of another; the angle in (-pi, pi].
Eigen::Vector3d pose_difference(const Se2& to, const Se2& from);

/// Inverse of pose_difference(): pose_difference(moved_by(pose, d), pose) is d.
Se2 moved_by(const Se2& pose, const Eigen::Vector3d& difference);

/// Exponential map of SE(2): the motion along the arc of the twist (x, y, theta) [m, m, rad]. Poses
/// that all move along arcs about one common centre keep their relative poses.
Se2 along_arc(const Eigen::Vector3d& step);

/// blockdiag(rotation, 1): rotates (x, y) of (x, y, theta).
Eigen::Matrix3d block_rotation(const Eigen::Matrix2d& rotation);

/// Converts a covariance or information of (x, y, theta) from the child's axes to the parent's:
/// R matrix R^T with R = block_rotation(rotation). @param rotation  of parent_from_child.
Eigen::Matrix3d in_axes(const Eigen::Matrix2d& rotation, const Eigen::Matrix3d& matrix);

/// Jacobian of a pose at the end of a lever arm by the pose at its start: identity, but
/// d(x, y)/d(theta) = (-dy, dx). @param lever  (dx, dy) [m], in the axes of the poses.
Eigen::Matrix3d lever_arm_jacobian(const Eigen::Vector2d& lever);

/// Covariance of a pose at the end of a lever arm: J covariance J^T, J = lever_arm_jacobian(lever).
/// @param covariance  of the pose at the start of the lever arm.
Eigen::Matrix3d at_end_of_lever(const Eigen::Matrix3d& covariance, const Eigen::Vector2d& lever);

}  // namespace waymark
