// SPDX-License-Identifier: BSD-3-Clause
// What tests of the fit of patterns have in common.
#pragma once

#include "common/markers/marker_dictionary.hpp"
#include "common/robot/camera_model.hpp"
#include "detector/core/marker_pattern.hpp"
#include "detector/core/square_pose.hpp"

#include <algorithm>
#include <cstddef>

namespace waymark::testing {

/// Of the default dictionary.
inline const MarkerPattern& pattern_of(int id) {
  static const auto patterns = marker_patterns(*find_dictionary(RobotConfig{}.markers.dictionary));
  return patterns[static_cast<std::size_t>(id)];
}

/// True corners of a marker in the image.
inline Corners raw_corners_px(const RobotConfig& robot,
                              const Eigen::Isometry3d& camera_from_marker) {
  const CameraModel camera{robot.camera};
  Corners corners_px;
  std::ranges::transform(
      corners_in_marker(robot.markers.size_m), corners_px.begin(),
      [&](const Eigen::Vector3d& corner) {
        return camera.raw_from_ideal(camera.project(camera_from_marker * corner));
      });
  return corners_px;
}

}  // namespace waymark::testing
