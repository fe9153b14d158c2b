// SPDX-License-Identifier: BSD-3-Clause
// The area of the floor plan in which the detector finds every marker.
#pragma once

#include "common/geometry/se2.hpp"

#include <Eigen/Core>

#include <cmath>

namespace waymark {

/// A horizontal wedge in front of the camera. A missing detection is evidence only inside it.
struct CameraView {
  Se2 base_from_camera{};   ///< x = viewing direction
  double left_rad{0.45};    ///< edges of the wedge, counter-clockwise from the viewing direction,
  double right_rad{-0.45};  ///< so far inside the image that a whole marker fits
  double range_min_m{0.3};  ///< nearer markers do not fit into the image
  double range_max_m{3.3};  ///< markers further away may be missed

  bool would_show(const Eigen::Vector2d& point_in_base) const {
    const Eigen::Vector2d point_in_camera = base_from_camera.inverse() * point_in_base;
    const double range_m = point_in_camera.norm();
    const double bearing_rad = std::atan2(point_in_camera.y(), point_in_camera.x());
    return range_m >= range_min_m && range_m <= range_max_m && bearing_rad >= right_rad &&
           bearing_rad <= left_rad;
  }
};

}  // namespace waymark
