// SPDX-License-Identifier: BSD-3-Clause
// Small deviations of poses, and how they and their covariances move along.
#pragma once

#include "common/geometry/se2.hpp"

#include <Eigen/Core>

namespace waymark {

/// Deviation (x, y, theta) of one pose from another.
inline Eigen::Vector3d deviation(const Se2& from, const Se2& to) {
  return {to.x() - from.x(), to.y() - from.y(), angle_difference(to.theta(), from.theta())};
}

/// How a deviation at one place shows at another, `step_in_map` further on: a turn moves it
/// sideways.
inline Eigen::Matrix3d carried_along(const Eigen::Vector2d& step_in_map) {
  Eigen::Matrix3d by = Eigen::Matrix3d::Identity();
  by(0, 2) = -step_in_map.y();
  by(1, 2) = step_in_map.x();
  return by;
}

/// The same for the covariance of deviations.
inline Eigen::Matrix3d carried_along(const Eigen::Matrix3d& covariance,
                                     const Eigen::Vector2d& step_in_map) {
  const Eigen::Matrix3d by = carried_along(step_in_map);
  return by * covariance * by.transpose();
}

/// The pose moved by a deviation.
inline Se2 deviated(const Se2& pose, const Eigen::Vector3d& by) {
  return {Eigen::Vector2d{pose.translation() + by.head<2>()}, pose.theta() + by.z()};
}

}  // namespace waymark
