// SPDX-License-Identifier: BSD-3-Clause
#include "common/robot/camera_model.hpp"

#include <algorithm>

namespace waymark {

CameraModel::CameraModel(const CameraConfig& config)
    : fx_px_{config.fx_px},
      fy_px_{config.fy_px},
      cx_px_{config.cx_px},
      cy_px_{config.cy_px},
      k1_{config.distortion.at(0)},
      k2_{config.distortion.at(1)},
      p1_{config.distortion.at(2)},
      p2_{config.distortion.at(3)},
      k3_{config.distortion.at(4)},
      has_distortion_{std::ranges::any_of(config.distortion, [](double k) { return k != 0.0; })} {}

Eigen::Vector2d CameraModel::project(const Eigen::Vector3d& point_in_camera_m) const {
  return ideal_from_normalized(point_in_camera_m.hnormalized());
}

Eigen::Matrix<double, 2, 3> CameraModel::projection_jacobian(
    const Eigen::Vector3d& point_in_camera_m) const {
  const double inverse_z = 1.0 / point_in_camera_m.z();
  const Eigen::Vector2d normalized = point_in_camera_m.hnormalized();
  Eigen::Matrix<double, 2, 3> jacobian;
  jacobian << fx_px_ * inverse_z, 0.0, -fx_px_ * normalized.x() * inverse_z,  //
      0.0, fy_px_ * inverse_z, -fy_px_ * normalized.y() * inverse_z;
  return jacobian;
}

Eigen::Vector2d CameraModel::raw_from_ideal(const Eigen::Vector2d& ideal_px) const {
  if (!has_distortion_) return ideal_px;
  const Eigen::Vector2d p = normalized_from_ideal(ideal_px);
  const double r2 = p.squaredNorm();
  const double radial = 1.0 + r2 * (k1_ + r2 * (k2_ + r2 * k3_));
  const double xy = p.x() * p.y();
  return ideal_from_normalized(
      {p.x() * radial + 2.0 * p1_ * xy + p2_ * (r2 + 2.0 * p.x() * p.x()),
       p.y() * radial + p1_ * (r2 + 2.0 * p.y() * p.y()) + 2.0 * p2_ * xy});
}

Eigen::Vector2d CameraModel::ideal_from_raw(const Eigen::Vector2d& raw_px) const {
  if (!has_distortion_) return raw_px;
  constexpr int kMaxSteps = 50;
  constexpr double kCloseEnoughPx = 1e-9;
  Eigen::Vector2d ideal_px = raw_px;
  for (int step = 0; step < kMaxSteps; ++step) {
    const Eigen::Vector2d miss_px = raw_px - raw_from_ideal(ideal_px);
    ideal_px += miss_px;
    if (miss_px.norm() < kCloseEnoughPx) break;
  }
  return ideal_px;
}

Eigen::Vector2d CameraModel::normalized_from_ideal(const Eigen::Vector2d& ideal_px) const {
  return {(ideal_px.x() - cx_px_) / fx_px_, (ideal_px.y() - cy_px_) / fy_px_};
}

Eigen::Vector2d CameraModel::ideal_from_normalized(const Eigen::Vector2d& normalized) const {
  return {fx_px_ * normalized.x() + cx_px_, fy_px_ * normalized.y() + cy_px_};
}

}  // namespace waymark
