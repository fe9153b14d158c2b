// SPDX-License-Identifier: BSD-3-Clause
#include "slam/core/belief/told_axes.hpp"

namespace waymark {

PoseAxes told_axes(const Observability& walls_in_base, const Belief& belief) {
  const Eigen::Vector2d weak = belief.map_from_base().rotation() * walls_in_base.weak_direction;
  const Eigen::Vector3d along{weak.x(), weak.y(), 0.0};
  PoseAxes axes(3, walls_in_base.is_degenerate ? 2 : 3);
  axes.col(0) = Eigen::Vector3d::UnitZ();
  axes.col(1) << -weak.y(), weak.x(), 0.0;
  if (!walls_in_base.is_degenerate) {
    axes.col(2) = along;
    return axes;
  }
  const Eigen::Vector3d with_along = belief.pose_covariance() * along;
  const double variance = along.dot(with_along);
  for (Eigen::Index i = 0; variance > 0.0 && i < axes.cols(); ++i)
    axes.col(i) -= with_along.dot(axes.col(i)) / variance * along;
  return axes;
}

}  // namespace waymark
