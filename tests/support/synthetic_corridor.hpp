// SPDX-License-Identifier: BSD-3-Clause
// Sensor values of a drive down a bare corridor, computed in milliseconds without physics or
// pixels.
#pragma once

#include "common/sensors/sensors.hpp"

#include <cstdint>
#include <vector>

namespace waymark::test {

struct SyntheticMarker {
  int id{0};
  Eigen::Vector2d position_m{Eigen::Vector2d::Zero()};  ///< world
  double yaw_rad{0.0};                                  ///< direction that it faces
};

/// World frame: corridor along +x from 0 to length_m, middle at y = 0, walls all around.
struct SyntheticCorridor {
  double length_m{50.0};
  double width_m{2.0};
  double start_x_m{1.0};
  double drive_m{48.0};
  double turn_back_every_m{0.0};  ///< turns on the spot after so many metres; 0: never
  double speed_m_s{0.1};
  double initial_heading_rad{0.0};
  double wander_rad{0.02};  ///< amplitude of the heading about the corridor's axis

  std::vector<SyntheticMarker> markers{};

  // Odometry errors, as the simulator's defaults.
  double scale_error{0.01};
  double turn_scale_error{0.005};
  double along_noise_per_sqrt_m{0.003};
  double turn_noise_per_sqrt_m{0.0087};

  int num_beams{360};
  double lidar_x_m{-0.064};
  double range_max_m{3.5};
  double range_sigma_m{0.01};

  double camera_x_m{0.076};
  double camera_half_view_rad{0.543};
  double camera_focal_error{0.0};    ///< relative: its focal length is longer than configured
  double camera_yaw_error_rad{0.0};  ///< it is mounted further left than configured
  double marker_size_m{0.4};
  double sighting_noise{2.0};  ///< factor on the errors measured on rendered frames

  std::uint64_t seed{1};
};

/// Markers on both walls at first_m, first_m + spacing_m, ..., opposite each other, ids from 0.
std::vector<SyntheticMarker> opposite_markers(const SyntheticCorridor& corridor,
                                              double first_m = 4.0, double spacing_m = 4.0);

struct TruePose {
  Timestamp time{};
  Se2 world_from_base{};
};

struct SensorLog {
  std::vector<OdometrySample> odometry{};  ///< 30 Hz
  std::vector<TruePose> truth{};           ///< at the odometry's times
  std::vector<LidarScan> scans{};          ///< 5 Hz
  std::vector<MarkerDetections> frames{};  ///< 10 Hz
};

SensorLog drive(const SyntheticCorridor& corridor);

/// The scan without noise from a pose.
LidarScan scan_from(const SyntheticCorridor& corridor, const Se2& world_from_base, Timestamp time);

/// Detection of a marker without errors; the covariance is that of a cautious detector.
MarkerDetection detection_of(const SyntheticMarker& marker, const Se2& world_from_base,
                             const SyntheticCorridor& corridor);

/// The same drive, mirrored along the corridor: left becomes right.
SensorLog mirrored(const SensorLog& log);

}  // namespace waymark::test
