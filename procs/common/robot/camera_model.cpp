// SPDX-License-Identifier: BSD-3-Clause
#include "common/robot/camera_model.hpp"

#include <Eigen/LU>

#include <algorithm>
#include <limits>

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
  return ideal_from_normalized(distort(normalized_from_ideal(ideal_px)));
}

Eigen::Vector2d CameraModel::ideal_from_raw(const Eigen::Vector2d& raw_px) const {
  if (!has_distortion_) return raw_px;
  constexpr int kMaxSteps = 50;
  constexpr double kCloseEnoughPx = 1e-9;
  constexpr double kSmallestChange = 1e-12;
  const Eigen::Vector2d distorted = normalized_from_ideal(raw_px);
  // Where the determinant of the Jacobian is negative, the lens model is folded: several rays have
  // the same pixel.
  const auto is_folded = [this](const Eigen::Vector2d& p) {
    return !(distortion_jacobian(p).determinant() > 0.0);
  };
  Eigen::Vector2d p = distorted;
  for (int step = 0; step < kMaxSteps; ++step) {
    if (is_folded(p)) {
      p *= 0.5;  // towards the centre, which is not folded
      continue;
    }
    const Eigen::Vector2d miss = distorted - distort(p);
    if (Eigen::Vector2d{fx_px_ * miss.x(), fy_px_ * miss.y()}.norm() < kCloseEnoughPx)
      return ideal_from_normalized(p);
    Eigen::Vector2d change = distortion_jacobian(p).inverse() * miss;
    while (is_folded(p + change) && change.norm() > kSmallestChange)
      change *= 0.5;
    p += change;
  }
  return Eigen::Vector2d::Constant(std::numeric_limits<double>::quiet_NaN());
}

Eigen::Vector2d CameraModel::distort(const Eigen::Vector2d& p) const {
  const double r2 = p.squaredNorm();
  const double radial = 1.0 + r2 * (k1_ + r2 * (k2_ + r2 * k3_));
  const double xy = p.x() * p.y();
  return {p.x() * radial + 2.0 * p1_ * xy + p2_ * (r2 + 2.0 * p.x() * p.x()),
          p.y() * radial + p1_ * (r2 + 2.0 * p.y() * p.y()) + 2.0 * p2_ * xy};
}

Eigen::Matrix2d CameraModel::distortion_jacobian(const Eigen::Vector2d& p) const {
  const double r2 = p.squaredNorm();
  const double radial = 1.0 + r2 * (k1_ + r2 * (k2_ + r2 * k3_));
  const double radial_by_r2 = k1_ + r2 * (2.0 * k2_ + r2 * 3.0 * k3_);
  const double mixed = 2.0 * (p.x() * p.y() * radial_by_r2 + p1_ * p.x() + p2_ * p.y());
  Eigen::Matrix2d jacobian;
  jacobian << radial + 2.0 * (p.x() * p.x() * radial_by_r2 + p1_ * p.y() + 3.0 * p2_ * p.x()),
      mixed, mixed, radial + 2.0 * (p.y() * p.y() * radial_by_r2 + 3.0 * p1_ * p.y() + p2_ * p.x());
  return jacobian;
}

Eigen::Vector2d CameraModel::normalized_from_ideal(const Eigen::Vector2d& ideal_px) const {
  return {(ideal_px.x() - cx_px_) / fx_px_, (ideal_px.y() - cy_px_) / fy_px_};
}

Eigen::Vector2d CameraModel::ideal_from_normalized(const Eigen::Vector2d& normalized) const {
  return {fx_px_ * normalized.x() + cx_px_, fy_px_ * normalized.y() + cy_px_};
}

}  // namespace waymark
