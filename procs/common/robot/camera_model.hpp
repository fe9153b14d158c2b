// SPDX-License-Identifier: BSD-3-Clause
// The camera's projection: a pinhole with OpenCV's five-parameter lens in front of it.
#pragma once

#include "common/robot/robot_config.hpp"

#include <Eigen/Core>

namespace waymark {

/// Converts between three things: points in the optical frame (x right, y down, z forward, [m]),
/// "ideal" pixels that a camera without lens distortion would see, and raw pixels of the image.
/// Pixel centres are integers. Straight edges are straight in ideal pixels only.
class CameraModel {
 public:
  /// @param config its distortion has five entries (CameraConfig::check()).
  explicit CameraModel(const CameraConfig& config);

  /// Ideal pixel of a point in front of the camera (z > 0).
  Eigen::Vector2d project(const Eigen::Vector3d& point_in_camera_m) const;
  /// Derivative of project() with respect to the point [px/m].
  Eigen::Matrix<double, 2, 3> projection_jacobian(const Eigen::Vector3d& point_in_camera_m) const;

  Eigen::Vector2d raw_from_ideal(const Eigen::Vector2d& ideal_px) const;
  /// Inverse of raw_from_ideal(), by Newton's method to 1e-9 px; NaN where the distortion cannot be
  /// inverted.
  Eigen::Vector2d ideal_from_raw(const Eigen::Vector2d& raw_px) const;
  /// (x, y) at z = 1, in the optical frame, of the ray through an ideal pixel.
  Eigen::Vector2d normalized_from_ideal(const Eigen::Vector2d& ideal_px) const;

 private:
  /// Lens distortion at z = 1.
  Eigen::Vector2d distort(const Eigen::Vector2d& normalized) const;
  /// Derivative of distort().
  Eigen::Matrix2d distortion_jacobian(const Eigen::Vector2d& normalized) const;
  Eigen::Vector2d ideal_from_normalized(const Eigen::Vector2d& normalized) const;

  double fx_px_;
  double fy_px_;
  double cx_px_;
  double cy_px_;
  double k1_;
  double k2_;
  double p1_;
  double p2_;
  double k3_;
  bool has_distortion_;
};

}  // namespace waymark
