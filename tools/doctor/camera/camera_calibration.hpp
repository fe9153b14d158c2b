// SPDX-License-Identifier: BSD-3-Clause
// Focal length, marker size, mounting and stamps of the camera, from markers that are seen again
// and from the walls that the LiDAR sees behind them.
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
  Measured yaw_rad{};      ///< true minus described
  Measured late_s{};       ///< frames show what odometry shows at their stamp minus this
  int num_walls{0};        ///< sightings with a wall behind them
  int num_pairs{0};        ///< two sightings of one marker
  int num_tracks{0};       ///< stretches in which one marker was in view
};

/// How well odometry's scales are known, relative.
struct ScaleSigmas {
  double distance_sigma{0.0};
  double turn_sigma{0.0};
};

/// Robust least squares (Gauss-Newton, Cauchy's weights) over two kinds of residuals: a marker's
/// centre lies on the straight wall that the LiDAR sees around it, and a marker is where it was
/// some decimetres or tens of degrees of odometry before. Sightings of a track err together: the
/// covariance is the jackknife's over tracks (how much the result moves without each of them),
/// nowhere below that of independent residuals.
/// @param log         its robot.lidar is where the LiDAR is; odometry with its scales put right
/// @param lidar_late  subtracted from the scans' times
/// @return nullopt for less than four tracks: their spread is not known
std::optional<CameraCalibration> calibrate_camera(const std::vector<CameraSighting>& sightings,
                                                  const CameraConfig& camera,
                                                  const MarkerConfig& markers,
                                                  const ImportedLog& log, Duration lidar_late,
                                                  const ScaleSigmas& scales);

/// Odometry with its distances and turns divided by these, from the same first pose.
std::vector<ImportedPose> rescaled(const std::vector<ImportedPose>& odometry, double distance_scale,
                                   double turn_scale);

}  // namespace waymark
