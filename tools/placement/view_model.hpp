// SPDX-License-Identifier: BSD-3-Clause
// What a view of a marker would say: how often it is read, and how well it is measured then.
#pragma once

#include "common/robot/camera_model.hpp"
#include "slam/core/landmark/marker_measurement.hpp"
#include "slam/slam_config.hpp"

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <optional>
#include <span>

namespace waymark::placement {

struct MarkerView {
  double read_share{0.0};  ///< of the frames
  MarkerMeasurement measurement{};
};

/// Share of the frames in which the detector reads a marker whose modules are that large.
double read_share_of(double module_px);

/// Corner noise as the detector describes it, through its pose of the square, then held to the wall
/// as the estimator does it: its own functions, on measurements without errors. Markers hang as
/// high as the camera.
class ViewModel {
 public:
  /// @param modules_per_side  bits along a side of the dictionary's markers, plus two of the
  /// border.
  ViewModel(const SlamConfig& config, int modules_per_side);

  /// @param hits_in_base  ends of the LiDAR's beams.
  /// @param speed_mps     of the robot, between frame and scan.
  /// @return nothing where the marker is not wholly in the image, faces away, is too small, or too
  ///         uncertain to be used.
  std::optional<MarkerView> view(const Se2& base_from_marker,
                                 std::span<const Eigen::Vector2d> hits_in_base,
                                 double speed_mps) const;

  double reach_m() const { return reach_m_; }

 private:
  RobotConfig robot_;
  MarkerMeasurementConfig measurement_;
  OdometryNoise odometry_;
  MarkerSensors sensors_;
  Eigen::Isometry3d base_from_camera_;
  CameraModel camera_;
  int modules_per_side_;
  double corner_sigma_;
  double max_sigma_m_;
  double reach_m_;  ///< beyond, a marker square on is too small to be read
};

}  // namespace waymark::placement
