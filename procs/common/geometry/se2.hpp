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

/// Turns (x, y, theta) in the child's axes into the parent's.
inline Eigen::Matrix3d turning(const Se2& parent_from_child) {
  Eigen::Matrix3d turn = Eigen::Matrix3d::Identity();
  turn.topLeftCorner<2, 2>() = parent_from_child.rotation();
  return turn;
}

/// Covariance of (x, y, theta) in the child's axes, in the parent's.
inline Eigen::Matrix3d turned(const Se2& parent_from_child,
                              const Eigen::Matrix3d& covariance_in_child) {
  const Eigen::Matrix3d turn = turning(parent_from_child);
  return turn * covariance_in_child * turn.transpose();
}

}  // namespace waymark
