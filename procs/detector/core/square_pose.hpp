// SPDX-License-Identifier: BSD-3-Clause
// Third stage: the pose of a square from its four corners.
#pragma once

#include "common/robot/camera_model.hpp"
#include "detector/core/corner_refinement.hpp"

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <array>
#include <optional>

namespace waymark {

/// Corners of the black square in the marker frame [m], in the order of Corners.
inline std::array<Eigen::Vector3d, 4> corners_in_marker(double size_m) {
  const double h = 0.5 * size_m;
  return {Eigen::Vector3d{-h, h, 0}, Eigen::Vector3d{h, h, 0}, Eigen::Vector3d{h, -h, 0},
          Eigen::Vector3d{-h, -h, 0}};
}

struct SquarePose {
  Eigen::Isometry3d camera_from_marker{Eigen::Isometry3d::Identity()};
  double reprojection_error_px{0.0};  ///< root mean square over the four corners
};

/// A small or distant square has two poses that explain its corners almost equally well.
struct SquarePoses {
  SquarePose best{};
  SquarePose other{};
  /// Covariance of `best` [m^2, rad^2], order x y z rx ry rz: errors of translation and rotation
  /// along and about the axes of the camera's optical frame.
  Eigen::Matrix<double, 6, 6> covariance_in_camera{Eigen::Matrix<double, 6, 6>::Zero()};
};

/// Both poses in closed form (Collins, Bartoli, "Infinitesimal plane-based pose estimation", 2014),
/// each refined to the least reprojection error weighted by the corners' covariance. Marker
/// frame: see lcmtypes/marker_detection_t.lcm. nullopt when the corners are no square in front of
/// the camera.
std::optional<SquarePoses> solve_square(const MeasuredCorners& corners, const CameraModel& camera,
                                        double size_m);

}  // namespace waymark
