// SPDX-License-Identifier: BSD-3-Clause
// Pictures of square markers with exactly known geometry, for tests: independent of the simulator
// and of the detector's own camera model.
#pragma once

#include "common/random/random.hpp"
#include "common/robot/robot_config.hpp"

#include <Eigen/Geometry>
#include <opencv2/core.hpp>

#include <vector>

namespace waymark::testing {

struct PlacedMarker {
  int id{0};
  Eigen::Isometry3d camera_from_marker{Eigen::Isometry3d::Identity()};
};

/// Grey levels, blur and noise of the pictures.
struct ImageLook {
  double black{25.0};
  double white{215.0};
  double wall{140.0};
  double quiet_zone_modules{2.0};
  double blur_sigma_px{0.6};  ///< Gaussian point spread, beside the pixel's own area
  double noise_sigma{3.0};    ///< grey levels
};

/// The camera's picture: every pixel is the mean of 8 x 8 rays through lens, pinhole and marker
/// plane, blurred, with Gaussian noise, rounded to 8 bits.
cv::Mat render_markers(const RobotConfig& robot, const std::vector<PlacedMarker>& markers,
                       const ImageLook& look, Random random);

/// Pose of a marker that hangs on a wall or stands free: its centre in the base frame and the
/// direction (yaw in the base frame) that it faces; upright.
Eigen::Isometry3d base_from_upright_marker(const Eigen::Vector3d& centre_in_base_m,
                                           double facing_yaw_rad);

}  // namespace waymark::testing
