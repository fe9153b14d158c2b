// SPDX-License-Identifier: BSD-3-Clause
// What the robot measures, as plain values: the cores' inputs. Frames: REP-103, base = between the
// wheels on the floor, x forward, y left, z up.
#pragma once

#include "common/geometry/se2.hpp"
#include "common/time/time.hpp"

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <array>
#include <vector>

namespace waymark {

/// Id of "no marker". Every id >= 0, also 0, is a marker's.
constexpr int kNoMarker = -1;

/// Pose of the base by wheel odometry, in the frame that begins at its first sample.
struct OdometrySample {
  Timestamp time{};
  Se2 odom_from_base{};
};

/// One sweep of a planar LiDAR. All arrays have one entry per beam; beam_time_offsets is empty when
/// all beams are taken at the same instant.
struct LidarScan {
  Timestamp time{};
  std::vector<double> ranges_m{};    ///< +inf = no return within range, NaN = invalid (REP-117)
  std::vector<double> angles_rad{};  ///< counter-clockwise from x, LiDAR frame
  std::vector<Duration> beam_time_offsets{};  ///< a beam is measured at time + its offset
};

/// One square marker in one image. Its coordinate frame: lcmtypes/marker_detection_t.lcm.
struct MarkerDetection {
  int id{kNoMarker};
  /// Clockwise from the marker's top left.
  std::array<Eigen::Vector2d, 4> corners_px{Eigen::Vector2d::Zero(), Eigen::Vector2d::Zero(),
                                            Eigen::Vector2d::Zero(), Eigen::Vector2d::Zero()};
  Eigen::Isometry3d base_from_marker{Eigen::Isometry3d::Identity()};
  /// Order x y z rx ry rz [m^2, rad^2]; errors added in the base frame, rotations about its axes.
  Eigen::Matrix<double, 6, 6> covariance_in_base{Eigen::Matrix<double, 6, 6>::Zero()};
  double reprojection_error_px{0.0};
  Eigen::Isometry3d other_base_from_marker{
      Eigen::Isometry3d::Identity()};  ///< the flipped solution
  double other_reprojection_error_px{0.0};
  double width_px{0.0};
};

/// All known markers of one frame; the list may be empty.
struct MarkerDetections {
  Timestamp time{};
  int image_width_px{0};
  int image_height_px{0};
  std::vector<MarkerDetection> detections{};
};

}  // namespace waymark
