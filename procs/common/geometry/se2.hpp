// SPDX-License-Identifier: BSD-3-Clause
// Rigid motions of the plane.
#pragma once

#include "common/geometry/angle.hpp"

#include <Eigen/Core>

#include <cmath>

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

  Eigen::Matrix2d rotation() const {
    const double c = std::cos(theta_rad_);
    const double s = std::sin(theta_rad_);
    return (Eigen::Matrix2d{} << c, -s, s, c).finished();
  }

  Se2 inverse() const { return {-(rotation().transpose() * translation_), -theta_rad_}; }

  Se2 operator*(const Se2& child) const {
    return {rotation() * child.translation_ + translation_, theta_rad_ + child.theta_rad_};
  }

  Eigen::Vector2d operator*(const Eigen::Vector2d& point_in_child) const {
    return rotation() * point_in_child + translation_;
  }

 private:
  Eigen::Vector2d translation_{Eigen::Vector2d::Zero()};
  double theta_rad_{0.0};
};

/// Pose between two poses: `from` at fraction 0, `to` at 1; turns the short way.
inline Se2 interpolate(const Se2& from, const Se2& to, double fraction) {
  return {from.translation() + fraction * (to.translation() - from.translation()),
          from.theta() + fraction * angle_difference(to.theta(), from.theta())};
}

/// (x, y, theta) of one pose minus those of another; the angle in (-pi, pi].
inline Eigen::Vector3d pose_difference(const Se2& to, const Se2& from) {
  return {to.x() - from.x(), to.y() - from.y(), angle_difference(to.theta(), from.theta())};
}

/// The pose that differs by so much: pose_difference(moved_by(pose, d), pose) is d.
inline Se2 moved_by(const Se2& pose, const Eigen::Vector3d& difference) {
  return {Eigen::Vector2d{pose.translation() + difference.head<2>()},
          pose.theta() + difference.z()};
}

/// The motion along an arc that begins with this (x, y, theta) (the exponential map of SE(2)).
/// Poses that are moved so, each by a common turn as seen from its own frame, keep what lies
/// between them.
inline Se2 along_arc(const Eigen::Vector3d& step) {
  const double half_rad = 0.5 * step.z();
  const double chord =
      std::abs(half_rad) < 1e-4 ? 1.0 - half_rad * half_rad / 6.0 : std::sin(half_rad) / half_rad;
  return {Eigen::Vector2d{chord * (Se2{0.0, 0.0, half_rad} * step.head<2>())}, step.z()};
}

/// Turns (x, y, theta) into axes that are turned by `rotation`.
inline Eigen::Matrix3d turning(const Eigen::Matrix2d& rotation) {
  Eigen::Matrix3d turn = Eigen::Matrix3d::Identity();
  turn.topLeftCorner<2, 2>() = rotation;
  return turn;
}

/// Covariance or information of (x, y, theta) in axes that are turned by `rotation`: of the child
/// in the parent's axes with the rotation of parent_from_child.
inline Eigen::Matrix3d in_axes(const Eigen::Matrix2d& rotation, const Eigen::Matrix3d& matrix) {
  const Eigen::Matrix3d turn = turning(rotation);
  return turn * matrix * turn.transpose();
}

/// How a difference of poses at one place shows at another, `step_in_map` further on: a turn moves
/// it sideways.
inline Eigen::Matrix3d carried_along(const Eigen::Vector2d& step_in_map) {
  Eigen::Matrix3d by = Eigen::Matrix3d::Identity();
  by(0, 2) = -step_in_map.y();
  by(1, 2) = step_in_map.x();
  return by;
}

/// The same for the covariance of such differences.
inline Eigen::Matrix3d carried_along(const Eigen::Matrix3d& covariance,
                                     const Eigen::Vector2d& step_in_map) {
  const Eigen::Matrix3d by = carried_along(step_in_map);
  return by * covariance * by.transpose();
}

}  // namespace waymark
