// SPDX-License-Identifier: BSD-3-Clause
#include "common/geometry/se2.hpp"

#include <cmath>

namespace waymark {

Eigen::Matrix2d Se2::rotation() const {
  const double c = std::cos(theta_rad_);
  const double s = std::sin(theta_rad_);
  return (Eigen::Matrix2d{} << c, -s, s, c).finished();
}

Se2 Se2::inverse() const {
  return {-(rotation().transpose() * translation_), -theta_rad_};
}

Se2 Se2::operator*(const Se2& child) const {
  return {rotation() * child.translation_ + translation_, theta_rad_ + child.theta_rad_};
}

Eigen::Vector2d Se2::operator*(const Eigen::Vector2d& point_in_child) const {
  return rotation() * point_in_child + translation_;
}

Se2 interpolate(const Se2& from, const Se2& to, double fraction) {
  return {from.translation() + fraction * (to.translation() - from.translation()),
          from.theta() + fraction * angle_difference(to.theta(), from.theta())};
}

Eigen::Vector3d pose_difference(const Se2& to, const Se2& from) {
  return {to.x() - from.x(), to.y() - from.y(), angle_difference(to.theta(), from.theta())};
}

Se2 moved_by(const Se2& pose, const Eigen::Vector3d& difference) {
  return {Eigen::Vector2d{pose.translation() + difference.head<2>()},
          pose.theta() + difference.z()};
}

Se2 along_arc(const Eigen::Vector3d& step) {
  const double half_rad = 0.5 * step.z();
  const double chord =
      std::abs(half_rad) < 1e-4 ? 1.0 - half_rad * half_rad / 6.0 : std::sin(half_rad) / half_rad;
  return {Eigen::Vector2d{chord * (Se2{0.0, 0.0, half_rad} * step.head<2>())}, step.z()};
}

Eigen::Matrix3d block_rotation(const Eigen::Matrix2d& rotation) {
  Eigen::Matrix3d block = Eigen::Matrix3d::Identity();
  block.topLeftCorner<2, 2>() = rotation;
  return block;
}

Eigen::Matrix3d in_axes(const Eigen::Matrix2d& rotation, const Eigen::Matrix3d& matrix) {
  const Eigen::Matrix3d block = block_rotation(rotation);
  return block * matrix * block.transpose();
}

Eigen::Matrix3d lever_arm_jacobian(const Eigen::Vector2d& lever) {
  Eigen::Matrix3d jacobian = Eigen::Matrix3d::Identity();
  jacobian(0, 2) = -lever.y();
  jacobian(1, 2) = lever.x();
  return jacobian;
}

Eigen::Matrix3d at_end_of_lever(const Eigen::Matrix3d& covariance, const Eigen::Vector2d& lever) {
  const Eigen::Matrix3d jacobian = lever_arm_jacobian(lever);
  return jacobian * covariance * jacobian.transpose();
}

}  // namespace waymark
