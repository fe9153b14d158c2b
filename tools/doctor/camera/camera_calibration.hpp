// SPDX-License-Identifier: BSD-3-Clause
// Focal length, marker size, yaw and time offset of the camera, from repeated sightings of markers
// and from the walls that the LiDAR measures behind them.
#pragma once

#include "doctor/camera/camera_record.hpp"
#include "doctor/motion/hand_eye.hpp"
#include "import/log/imported_log.hpp"

#include <optional>
#include <vector>

namespace waymark {

struct CameraCalibration {
  Measured focal{};        ///< true over described focal length
  Measured marker_size{};  ///< true over described size
  Measured yaw_rad{};      ///< true yaw minus described yaw
  Measured late_s{};       ///< delay of the frames' stamps, relative to odometry's clock
  int num_walls{0};        ///< sightings with a wall behind them
  int num_pairs{0};        ///< pairs of sightings of one marker
  int num_tracks{0};       ///< sequences of sightings of one marker with pauses of at most 2 s
};

/// Relative standard deviations of odometry's scales.
struct ScaleSigmas {
  double distance_sigma{0.0};
  double turn_sigma{0.0};
};

/// Robust least squares (Gauss-Newton, Cauchy's weights) over two kinds of residuals: a marker's
/// centre lies on the straight wall that the LiDAR measures around it, and a marker has not moved
/// between two sightings some decimetres or tens of degrees of odometry apart. Errors within a
/// track are correlated: the covariance is the jackknife's over tracks, but not below that of
/// independent residuals, and includes the uncertainty of odometry's scales.
/// @param log         with the LiDAR's true mounting in robot.lidar, and corrected odometry scales.
/// @param lidar_late  subtracted from the scans' times.
/// @return nullopt for less than four tracks, whose spread would be unknown.
std::optional<CameraCalibration> calibrate_camera(const std::vector<CameraSighting>& sightings,
                                                  const CameraConfig& camera,
                                                  const MarkerConfig& markers,
                                                  const ImportedLog& log, Duration lidar_late,
                                                  const ScaleSigmas& scales);

/// Odometry with distances and turns divided by these scales; the first pose stays.
std::vector<ImportedPose> rescaled(const std::vector<ImportedPose>& odometry, double distance_scale,
                                   double turn_scale);

}  // namespace waymark
