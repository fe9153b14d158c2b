// SPDX-License-Identifier: BSD-3-Clause
// Predicts a view of a marker: how often it is read, and the covariance of its measurement.
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
  double read_share{0.0};  ///< share of the frames in which the detector reads it
  MarkerMeasurement measurement{};
};

/// Share of the frames in which the detector reads a marker with modules of that size [px].
double read_share_of(double module_px);

/// Propagates the detector's corner noise, linearised at measurements without errors, through pose
/// estimation and alignment to the wall, with the functions of detector and estimator.
class ViewModel {
 public:
  /// @param modules_per_side  bits along a side of a marker plus two modules of border.
  /// @param marker_height_m   height of every marker's centre over the floor.
  ViewModel(const SlamConfig& config, int modules_per_side, double marker_height_m);

  /// @param hits_in_base  ends of the LiDAR's beams, base frame.
  /// @param speed_mps     speed of the robot between frame and scan.
  /// @return nothing if the marker is not completely in the image, faces away, is too small, or is
  ///         too uncertain to be used.
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
  double marker_height_m_;
  double max_sigma_m_;
  double reach_m_;  ///< farther away, even a marker seen frontally is too small to be read
};

}  // namespace waymark::placement
