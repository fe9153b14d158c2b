// SPDX-License-Identifier: BSD-3-Clause
// Gaussian knowledge about a pose, in the form that adds up.
#pragma once

#include "common/geometry/se2.hpp"

#include <Eigen/Core>

namespace waymark {

/// Second-order model of a negative log-likelihood about a pose:
/// cost + gradient' d + d' information d / 2, d = (x, y, theta) deviation in the map frame.
struct PoseInformation {
  Eigen::Matrix3d information{Eigen::Matrix3d::Zero()};
  Eigen::Vector3d gradient{Eigen::Vector3d::Zero()};
  double cost{0.0};

  PoseInformation& operator+=(const PoseInformation& other) {
    information += other.information;
    gradient += other.gradient;
    cost += other.cost;
    return *this;
  }
};

/// What is left of a deviation that is measured when what it is measured from is uncertain, too.
Eigen::Matrix3d share_left(const PoseInformation& measured, const Eigen::Matrix3d& uncertainty);

/// A measurement from something that is itself uncertain: its covariance adds to the measurement's.
PoseInformation blurred(const PoseInformation& measured, const Eigen::Matrix3d& uncertainty);

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

/// Projects (x, y, theta) to what has nothing of a unit direction.
Eigen::Matrix3d without(const Eigen::Vector2d& direction);

/// The part of a symmetric matrix with positive eigenvalues.
Eigen::Matrix3d positive_part(const Eigen::Matrix3d& symmetric);

inline Se2 deviated(const Se2& pose, const Eigen::Vector3d& by) {
  return {Eigen::Vector2d{pose.translation() + by.head<2>()}, pose.theta() + by.z()};
}

}  // namespace waymark
