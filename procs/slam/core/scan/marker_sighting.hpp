// SPDX-License-Identifier: BSD-3-Clause
// A detected marker in the plane of the map.
#pragma once

#include "common/geometry/se2.hpp"
#include "common/sensors/sensors.hpp"

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <optional>

namespace waymark {

/// A marker seen from above: the segment between its two vertical edges, in the base frame at the
/// time of the scan that it is used with.
struct MarkerSighting {
  int id{kNoMarker};
  Timestamp time{};        ///< of the camera frame
  Se2 base_from_marker{};  ///< centre, and the direction that the marker faces
  /// [m^2, m rad, rad^2] order x y yaw, base frame.
  Eigen::Matrix3d covariance_in_base{Eigen::Matrix3d::Zero()};
  double size_m{0.0};  ///< side of the black square
  /// Motion by odometry between camera frame and scan: its noise is not in the covariance.
  double driven_since_frame_m{0.0};
  double turned_since_frame_rad{0.0};

  /// Point on the marker's line, `right_m` to the right of its centre as it is printed.
  Eigen::Vector2d point_at(double right_m) const {
    const double yaw_rad = base_from_marker.theta();
    return base_from_marker.translation() +
           right_m * Eigen::Vector2d{-std::sin(yaw_rad), std::cos(yaw_rad)};
  }

  /// Standard deviation of the centre along the marker's line, which is its wall [m].
  double sigma_along_wall_m() const {
    const double yaw_rad = base_from_marker.theta();
    const Eigen::Vector2d along{-std::sin(yaw_rad), std::cos(yaw_rad)};
    return std::sqrt(std::max(0.0, along.dot(covariance_in_base.topLeftCorner<2, 2>() * along)));
  }
};

/// Covariance of (x, y, yaw).
/// @param covariance  of (x, y, z, rx, ry, rz), same frame.
Eigen::Matrix3d planar_covariance(const Eigen::Matrix<double, 6, 6>& covariance);

/// Projects a detection onto the plane and transforms it to the base frame at the scan's time.
/// @param scan_base_from_frame_base  motion by odometry between the times of camera frame and scan.
/// @return none for a marker that is not upright (tilted by more than 30 degrees: not on a wall of
///         a planar map), is farther than 100 m, or has an invalid covariance.
std::optional<MarkerSighting> sight_marker(const MarkerDetection& detection, Timestamp time,
                                           const Se2& scan_base_from_frame_base, double size_m);

}  // namespace waymark
