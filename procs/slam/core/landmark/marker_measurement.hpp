// SPDX-License-Identifier: BSD-3-Clause
// Pose of a marker in the base frame, from the camera and from the wall that the LiDAR sees there.
#pragma once

#include "common/geometry/chi2.hpp"
#include "common/geometry/se2.hpp"
#include "slam/core/landmark/sighting_noise.hpp"
#include "slam/core/motion/odometry_errors.hpp"
#include "slam/core/scan/observation.hpp"

#include <optional>
#include <span>
#include <vector>

namespace waymark {

class Fields;

struct MarkerMeasurementConfig {
  double reach_m{1.5};
  double covariance_factor{1.0};
  double gate{kChi2Gate3};  // wide for its two degrees of freedom: 99.97 %

  /// Names, units and explanations of the keys: core_fields.cpp.
  void describe(Fields& fields);
};

/// The sensors that measure markers.
struct MarkerSensors {
  double range_sigma_m{0.01};  ///< of the LiDAR
  Se2 base_from_camera{};
  SightingNoise sigmas{};
};

/// A straight piece of wall, base frame.
struct WallLine {
  Eigen::Vector2d point{Eigen::Vector2d::Zero()};    ///< the wall's point nearest to the marker
  Eigen::Vector2d normal{Eigen::Vector2d::UnitX()};  ///< unit, towards the robot
  double sigma_m{0.0};    ///< standard deviation across the wall at `point`
  double sigma_rad{0.0};  ///< standard deviation of the normal's direction
};

/// Fits a line to the beams' ends around a place, given its expected normal; none if too few beams
/// lie on a line. The place may lie beyond the beams: sigma_m grows with the distance from them.
std::optional<WallLine> fit_wall(std::span<const AnnotatedBeam> beams,
                                 const Eigen::Vector2d& place_in_base, double normal_rad,
                                 double range_sigma_m, double reach_m);

/// Innovation of a fitted wall, relative to the camera's measurement of a marker in it.
struct WallInnovation {
  /// Wall minus camera: distance [m] and direction [rad] of the wall's normal.
  Eigen::Vector2d residual{Eigen::Vector2d::Zero()};
  Eigen::Matrix2d jacobian_camera{Eigen::Matrix2d::Zero()};  ///< columns as in MarkerMeasurement
  Eigen::Vector2d jacobian_standoff{Eigen::Vector2d::UnitX()};
  Eigen::Matrix2d covariance{Eigen::Matrix2d::Identity()};

  Eigen::Matrix<double, 2, 3> jacobian_calibration() const {
    return (Eigen::Matrix<double, 2, 3>{} << jacobian_camera, jacobian_standoff).finished();
  }
};

/// Pose of a marker in the base frame with its covariance (order x y yaw).
struct MarkerMeasurement {
  int id{kNoMarker};
  Timestamp time{};
  double size_m{0.0};  ///< side of the black square
  Se2 base_from_marker{};
  Eigen::Matrix3d covariance{Eigen::Matrix3d::Zero()};
  /// d(x, y, yaw) / d(yaw of the camera's mounting [rad], focal length (relative)).
  Eigen::Matrix<double, 3, 2> jacobian_camera{Eigen::Matrix<double, 3, 2>::Zero()};
  /// d(x, y, yaw) / d(standoff from the wall [m]).
  Eigen::Vector3d jacobian_standoff{Eigen::Vector3d::Zero()};
  Se2 base_from_camera{};
  /// d(pose) / d(pose measured by the camera alone): I - K H of the update with the wall.
  Eigen::Matrix3d jacobian_view{Eigen::Matrix3d::Zero()};
  std::optional<WallInnovation> wall{};  ///< uncorrelated with the error of base_from_marker

  /// d(x, y, yaw) / d(camera yaw [rad], focal length (relative), standoff [m]).
  Eigen::Matrix3d jacobian_calibration() const {
    return (Eigen::Matrix3d{} << jacobian_camera, jacobian_standoff).finished();
  }

  /// jacobian_calibration(), linearised at the marker's estimated instead of its measured place: a
  /// Jacobian that contains the measurement's noise is correlated with the residual, and biases the
  /// calibration.
  Eigen::Matrix3d jacobian_calibration_at(const Eigen::Vector2d& place_in_base) const;
};

/// Measurements from the sightings of an observation's newest frame. The camera measures the
/// bearing best and the range worst; the wall complements the range. A view that the wall
/// contradicts (a flipped pose), or without a wall although beams end there, gives no measurement.
/// @param odometry  noise of the motion between the camera frame and the scan.
std::vector<MarkerMeasurement> measure_markers(const Observation& observation,
                                               const MarkerSensors& sensors,
                                               const OdometryNoise& odometry,
                                               const MarkerMeasurementConfig& config);

}  // namespace waymark
