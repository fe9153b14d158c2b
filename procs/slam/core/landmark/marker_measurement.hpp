// SPDX-License-Identifier: BSD-3-Clause
// Where a marker is from the robot: the camera's view of it, held to the wall that the LiDAR sees.
#pragma once

#include "common/geometry/se2.hpp"
#include "slam/core/landmark/sighting_sigmas.hpp"
#include "slam/core/motion/odometry_errors.hpp"
#include "slam/core/scan/observation.hpp"

#include <optional>
#include <span>
#include <vector>

namespace waymark {

class Fields;

struct MarkerMeasurementConfig {
  double reach_m{1.5};
  double perspective_sigma{0.02};
  double perspective_max_sigma{0.003};
  double covariance_factor{1.0};
  double gate{16.3};

  /// What they are, in words: core_fields.cpp.
  void describe(Fields& fields);
};

/// What markers are measured with.
struct MarkerSensors {
  double range_sigma_m{0.01};  ///< of the LiDAR
  Se2 base_from_camera{};
  SightingSigmas sigmas{};
};

/// A piece of straight wall, base frame.
struct WallLine {
  Eigen::Vector2d point{Eigen::Vector2d::Zero()};    ///< on it, nearest to the marker
  Eigen::Vector2d normal{Eigen::Vector2d::UnitX()};  ///< unit, towards the robot
  double sigma_m{0.0};                               ///< of the distance at `point`
  double sigma_rad{0.0};                             ///< of the direction
};

/// The line through the beams' ends around a place with an expected normal; nothing where too few
/// beams lie on one. The line may be extended: its uncertainty grows with the distance to the
/// beams.
std::optional<WallLine> fit_wall(std::span<const AnnotatedBeam> beams,
                                 const Eigen::Vector2d& place_in_base, double normal_rad,
                                 double range_sigma_m, double reach_m);

/// What the wall says about the camera: by how much the marker's view misses it.
struct WallInnovation {
  /// Wall minus view: distance [m] and direction [rad] of the wall's normal.
  Eigen::Vector2d residual{Eigen::Vector2d::Zero()};
  Eigen::Matrix2d by_camera{Eigen::Matrix2d::Zero()};  ///< as in MarkerMeasurement
  Eigen::Vector2d by_standoff{Eigen::Vector2d::UnitX()};
  Eigen::Matrix2d covariance{Eigen::Matrix2d::Identity()};

  Eigen::Matrix<double, 2, 3> by_errors() const {
    return (Eigen::Matrix<double, 2, 3>{} << by_camera, by_standoff).finished();
  }
};

/// Pose of a marker in the base frame with its covariance (order x y yaw).
struct MarkerMeasurement {
  int id{kNoMarker};
  Timestamp time{};
  double size_m{0.0};  ///< side of the black square
  Se2 base_from_marker{};
  Eigen::Matrix3d covariance{Eigen::Matrix3d::Zero()};
  /// By the camera's errors: mounted further left [rad], longer focal length (relative).
  Eigen::Matrix<double, 3, 2> by_camera{Eigen::Matrix<double, 3, 2>::Zero()};
  Eigen::Vector3d by_standoff{Eigen::Vector3d::Zero()};  ///< by the marker hanging before its wall
  Se2 base_from_camera{};
  Eigen::Matrix3d held{Eigen::Matrix3d::Zero()};  ///< what its wall leaves of an error of the view
  std::optional<FocalSighting> focal{};           ///< what the marker's perspective says
  std::optional<WallInnovation> wall{};           ///< its error is independent of the pose's

  /// By (camera yaw [rad], focal length (relative), standoff [m]).
  Eigen::Matrix3d by_errors() const {
    return (Eigen::Matrix3d{} << by_camera, by_standoff).finished();
  }

  /// The same if the marker is at another place than it was measured at, base frame: where it is
  /// known to be. Derivatives that have the measurement's own noise in them are correlated with the
  /// residual, and what is learnt by them is pushed to one side.
  Eigen::Matrix3d by_errors_at(const Eigen::Vector2d& place_in_base) const;
};

/// The sightings of an observation's newest frame as measurements. The corners tell the bearing
/// best and the range worst; where along that bearing the marker is, follows from the wall. A view
/// that the wall contradicts (a flipped pose) gives no measurement.
/// @param odometry  that carried the sightings from their frames' times to the scan's.
std::vector<MarkerMeasurement> measure_markers(const Observation& observation,
                                               const MarkerSensors& sensors,
                                               const OdometryNoise& odometry,
                                               const MarkerMeasurementConfig& config);

}  // namespace waymark
