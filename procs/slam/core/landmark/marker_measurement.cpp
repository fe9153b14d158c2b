// SPDX-License-Identifier: BSD-3-Clause
#include "slam/core/landmark/marker_measurement.hpp"

#include "common/geometry/principal_axes.hpp"
#include "common/geometry/squared.hpp"
#include "slam/core/registration/scan_match.hpp"

#include <Eigen/LU>

#include <algorithm>
#include <cmath>

namespace waymark {
namespace {

constexpr double kFirstBand_m = 0.15;  // largest distance of inliers from the expected line,
constexpr double kBand_m = 0.04;       // and from a fitted line
constexpr double kFirstReach_m = 1.0;
constexpr double kCovered_m = 0.5;
constexpr int kFits = 4;
constexpr int kMinBeams = 8;
constexpr double kMinExtent_m = 0.1;            // standard deviation of the points along the line
constexpr double kMaxTurn_rad = radians(25.0);  // between the camera's and the LiDAR's wall
constexpr double kRoughness_m = ScanMatchConfig{}.roughness_m;

// Ratio of variances of the odometry noise, a single wall to the mean of a sweep (MeanSweep). All
// beams on a wall are measured at about the same time, on average a quarter of the sweep from its
// middle: the wall has the noise of a quarter of the sweep, and the mean that of a twelfth.
constexpr double kWallOverMeanSweep = 3.0;

/// Least standard deviations of the calibration (order of SightingNoise::calibration) in the gate
/// for flipped poses: with a too confident description all views would be rejected.
const Eigen::Vector3d kMinCalibrationSigmas{0.01, 0.005, 0.005};

struct Line {
  Eigen::Vector2d point;
  Eigen::Vector2d normal;
};

/// Sums of a weighted least-squares line fit, weighted by the range noise across the line.
struct LineFit {
  double weight{0.0};
  int beams{0};
  Eigen::Vector2d sum{Eigen::Vector2d::Zero()};
  Eigen::Matrix2d squares{Eigen::Matrix2d::Zero()};

  void add(const Eigen::Vector2d& point, double variance) {
    weight += 1.0 / variance;
    sum += point / variance;
    squares += point * point.transpose() / variance;
    ++beams;
  }
};

LineFit collect(std::span<const AnnotatedBeam> beams, const Line& line,
                const Eigen::Vector2d& place, double band_m, double reach_m, double range_sigma_m) {
  LineFit fit;
  for (const AnnotatedBeam& annotated : beams) {
    const Beam& beam = annotated.beam;
    const Eigen::Vector2d offset = beam.end_in_base - place;
    if (std::abs(line.normal.dot(beam.end_in_base - line.point)) > band_m) continue;
    if (offset.norm() > reach_m) continue;
    const double across =
        line.normal.dot(beam.end_in_base - beam.start_in_base) / std::max(beam.range_m, 1e-6);
    fit.add(offset, squared(range_sigma_m * across) + squared(kRoughness_m));
  }
  return fit;
}

Eigen::Matrix3d covariance_in_base(const MarkerSighting& sighting, const MarkerSensors& sensors,
                                   const OdometryNoise& odometry,
                                   const MarkerMeasurementConfig& config) {
  const Eigen::Vector2d ray =
      sighting.base_from_marker.translation() - sensors.base_from_camera.translation();
  const Eigen::Vector2d across{-ray.y(), ray.x()};
  Eigen::Matrix3d covariance = config.covariance_factor * sighting.covariance_in_base;
  covariance.topLeftCorner<2, 2>() +=
      squared(sensors.sigmas.bearing_rad) * across * across.transpose();
  covariance.topLeftCorner<2, 2>().diagonal().array() += squared(sensors.sigmas.position_m);
  covariance(2, 2) += squared(sensors.sigmas.bearing_rad);
  // Odometry noise since the camera frame: a heading error turns the sighting about the robot.
  return covariance + at_end_of_lever(random_walk(sighting.driven_since_frame_m,
                                                  sighting.turned_since_frame_rad, odometry),
                                      sighting.base_from_marker.translation());
}

/// d(measured pose) / d(yaw of the mounting, relative focal length): a camera that is turned
/// further left than described sees everything turned to the right; with a longer focal length than
/// described everything seems nearer.
Eigen::Matrix<double, 3, 2> camera_jacobian(const Eigen::Vector2d& place_in_base,
                                            const Se2& base_from_camera) {
  const Eigen::Vector2d ray = place_in_base - base_from_camera.translation();
  const Eigen::Vector2d forward = base_from_camera.rotation().col(0);
  Eigen::Matrix<double, 3, 2> jacobian_camera;
  jacobian_camera.col(0) << ray.y(), -ray.x(), -1.0;
  jacobian_camera.col(1) << -forward.dot(ray) * forward, 0.0;
  return jacobian_camera;
}

/// Kalman update of the camera's view with the constraint that the marker lies in the wall and
/// faces along its normal. None: the gate rejects it.
/// @param sweep_covariance  of the motion between the scan's time and that of the wall's beams.
std::optional<MarkerMeasurement> constrain_to_wall(MarkerMeasurement measurement,
                                                   const WallLine& wall,
                                                   const Eigen::Matrix3d& sweep_covariance,
                                                   const SightingNoise& sigmas, double gate) {
  Eigen::Matrix<double, 2, 3> rows = Eigen::Matrix<double, 2, 3>::Zero();
  rows.topLeftCorner<1, 2>() = wall.normal.transpose();
  rows(1, 2) = 1.0;
  const Se2& seen = measurement.base_from_marker;
  const double normal_rad = std::atan2(wall.normal.y(), wall.normal.x());
  WallInnovation innovation;
  innovation.residual << wall.normal.dot(wall.point - seen.translation()),
      angle_difference(normal_rad, seen.theta());
  innovation.jacobian_camera = -rows * measurement.jacobian_camera;
  innovation.jacobian_standoff = -Eigen::Vector2d::UnitX();  // the normal points to the robot
  const Eigen::Matrix3d of_both =
      measurement.covariance + at_end_of_lever(sweep_covariance, wall.point);
  innovation.covariance = rows * of_both * rows.transpose();
  innovation.covariance(0, 0) += squared(wall.sigma_m) + squared(sigmas.bulge_m);
  innovation.covariance(1, 1) += squared(wall.sigma_rad) + squared(sigmas.skew_rad);

  const Eigen::Vector3d error_variance =
      sigmas.calibration.cwiseMax(kMinCalibrationSigmas).cwiseAbs2();
  const Eigen::Matrix2d spread =
      innovation.covariance + innovation.jacobian_calibration() * error_variance.asDiagonal() *
                                  innovation.jacobian_calibration().transpose();
  if (!(innovation.residual.dot(spread.inverse() * innovation.residual) < gate))
    return std::nullopt;

  const Eigen::Matrix<double, 3, 2> gain =
      measurement.covariance * rows.transpose() * innovation.covariance.inverse();
  measurement.base_from_marker = moved_by(seen, gain * innovation.residual);
  measurement.jacobian_camera += gain * innovation.jacobian_camera;
  measurement.jacobian_standoff = gain * innovation.jacobian_standoff;
  measurement.jacobian_view -= gain * rows;
  measurement.covariance -= (gain * rows * measurement.covariance).eval();
  measurement.covariance =
      (0.5 * (measurement.covariance + measurement.covariance.transpose())).eval();
  measurement.wall = innovation;
  return measurement;
}

/// Whether beams end around a marker: if no wall fits there, the marker's pose is wrong.
bool is_covered(std::span<const AnnotatedBeam> beams, const MarkerSighting& sighting) {
  const auto is_near = [&](const AnnotatedBeam& beam) {
    return (beam.beam.end_in_base - sighting.base_from_marker.translation()).norm() < kCovered_m;
  };
  return std::count_if(beams.begin(), beams.end(), is_near) >= kMinBeams;
}

}  // namespace

Eigen::Matrix3d MarkerMeasurement::jacobian_calibration_at(
    const Eigen::Vector2d& place_in_base) const {
  return (Eigen::Matrix3d{} << jacobian_view * camera_jacobian(place_in_base, base_from_camera),
          jacobian_standoff)
      .finished();
}

std::optional<WallLine> fit_wall(std::span<const AnnotatedBeam> beams,
                                 const Eigen::Vector2d& place_in_base, double normal_rad,
                                 double range_sigma_m, double reach_m) {
  const Eigen::Vector2d expected{std::cos(normal_rad), std::sin(normal_rad)};
  Line line{place_in_base, expected};
  LineFit fit;
  Eigen::Vector2d mean = Eigen::Vector2d::Zero();
  Eigen::Vector2d axis = Eigen::Vector2d::Zero();
  double extent = 0.0;  // weighted mean square length [m^2]
  for (int round = 0; round < kFits; ++round) {
    const bool is_first = round == 0;
    fit = collect(beams, line, place_in_base, is_first ? kFirstBand_m : kBand_m,
                  is_first ? std::min(kFirstReach_m, reach_m) : reach_m, range_sigma_m);
    if (fit.beams < kMinBeams) return std::nullopt;
    mean = fit.sum / fit.weight;
    const PrincipalAxes axes = principal_axes(fit.squares / fit.weight - mean * mean.transpose());
    extent = axes.values[1];
    axis = axes.directions.col(1);
    Eigen::Vector2d normal{-axis.y(), axis.x()};
    if (normal.dot(expected) < 0.0) normal = -normal;
    if (normal.dot(expected) < std::cos(kMaxTurn_rad)) return std::nullopt;
    line = {place_in_base + mean, normal};
  }
  if (extent < squared(kMinExtent_m)) return std::nullopt;
  WallLine wall;
  wall.normal = line.normal;
  const double ahead_m = axis.dot(-mean);
  wall.point = line.point + ahead_m * axis;
  wall.sigma_rad = 1.0 / std::sqrt(fit.weight * extent);
  wall.sigma_m = std::sqrt(1.0 / fit.weight + squared(ahead_m * wall.sigma_rad));
  return wall;
}

std::vector<MarkerMeasurement> measure_markers(const Observation& observation,
                                               const MarkerSensors& sensors,
                                               const OdometryNoise& odometry,
                                               const MarkerMeasurementConfig& config) {
  // The newest frame only, since the errors of successive frames are correlated.
  Timestamp newest{};
  for (const MarkerSighting& sighting : observation.sightings)
    newest = std::max(newest, sighting.time);
  const Eigen::Matrix3d sweep_covariance =
      kWallOverMeanSweep *
      random_walk(observation.mean_sweep.distance_m, observation.mean_sweep.turn_rad, odometry);
  std::vector<MarkerMeasurement> measurements;
  for (const MarkerSighting& sighting : observation.sightings) {
    if (sighting.time != newest) continue;
    const MarkerMeasurement measurement{
        sighting.id,
        sighting.time,
        sighting.size_m,
        sighting.base_from_marker,
        covariance_in_base(sighting, sensors, odometry, config),
        camera_jacobian(sighting.base_from_marker.translation(), sensors.base_from_camera),
        Eigen::Vector3d::Zero(),
        sensors.base_from_camera,
        Eigen::Matrix3d::Identity()};
    const auto wall =
        fit_wall(observation.beams, sighting.base_from_marker.translation(),
                 sighting.base_from_marker.theta(), sensors.range_sigma_m, config.reach_m);
    if (!wall) {
      if (!is_covered(observation.beams, sighting)) measurements.push_back(measurement);
    } else if (const auto constrained = constrain_to_wall(measurement, *wall, sweep_covariance,
                                                          sensors.sigmas, config.gate)) {
      measurements.push_back(*constrained);
    }
  }
  return measurements;
}

}  // namespace waymark
