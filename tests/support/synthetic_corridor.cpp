// SPDX-License-Identifier: BSD-3-Clause
#include "support/synthetic_corridor.hpp"

#include "common/random/random.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <numbers>

namespace waymark::test {
namespace {

enum Stream : std::uint64_t { kOdometryNoise = 1, kRangeNoise, kCameraNoise };

constexpr int kStepsPerSecond = 30;
constexpr int kStepsPerFrame = 3;
constexpr int kStepsPerScan = 6;

// Turn rate when the robot turns back on the spot.
constexpr double kTurn_rad_per_step = 0.5 / kStepsPerSecond;
constexpr double kAlongAxis_rad = 0.5;

Timestamp time_of_step(int step) {
  return timestamp_from_us(1'000'000 + static_cast<std::int64_t>(step) * 1'000'000 / 30);
}

/// Linear interpolation in a table of (x, y), constant beyond its ends.
double look_up(std::initializer_list<std::pair<double, double>> table, double x) {
  auto before = table.begin();
  if (x <= before->first) return before->second;
  for (auto after = std::next(before); after != table.end(); before = after++) {
    if (x > after->first) continue;
    const double fraction = (x - before->first) / (after->first - before->first);
    return before->second + fraction * (after->second - before->second);
  }
  return before->second;
}

/// Share of frames in which a marker is detected, by distance ahead: research/markers.md, table 4c.
double detection_rate(double ahead_m) {
  return look_up({{3.0, 1.0}, {3.75, 0.96}, {4.25, 0.9}, {4.75, 0.82}, {5.25, 0.44}, {5.6, 0.0}},
                 ahead_m);
}

double range_sigma_m(double ahead_m) {
  return look_up({{1.75, 1e-4},
                  {2.25, 3e-4},
                  {2.75, 6e-4},
                  {3.25, 1e-3},
                  {3.75, 2.7e-3},
                  {4.25, 2.9e-3},
                  {4.75, 5.8e-3}},
                 ahead_m);
}

constexpr double kBearingSigma_rad = radians(0.005);
constexpr double kYawSigma_rad = radians(0.2);

double ray_cast(const SyntheticCorridor& corridor, const Eigen::Vector2d& from,
                double direction_rad) {
  const Eigen::Vector2d direction{std::cos(direction_rad), std::sin(direction_rad)};
  const double half_m = 0.5 * corridor.width_m;
  double nearest_m = std::numeric_limits<double>::infinity();
  if (direction.x() > 0.0) nearest_m = (corridor.length_m - from.x()) / direction.x();
  if (direction.x() < 0.0) nearest_m = -from.x() / direction.x();
  if (direction.y() > 0.0) nearest_m = std::min(nearest_m, (half_m - from.y()) / direction.y());
  if (direction.y() < 0.0) nearest_m = std::min(nearest_m, (-half_m - from.y()) / direction.y());
  return nearest_m;
}

bool is_in_view(const SyntheticMarker& marker, const Se2& world_from_base,
                const SyntheticCorridor& corridor) {
  const Eigen::Vector2d camera = world_from_base * Eigen::Vector2d{corridor.camera_x_m, 0.0};
  const Eigen::Vector2d along{-std::sin(marker.yaw_rad), std::cos(marker.yaw_rad)};
  for (const double side_m : {-0.5 * corridor.marker_size_m, 0.5 * corridor.marker_size_m}) {
    const Eigen::Vector2d edge =
        world_from_base.rotation().transpose() * (marker.position_m + side_m * along - camera);
    if (edge.x() <= 0.0) return false;
    if (std::abs(std::atan2(edge.y(), edge.x())) > corridor.camera_half_view_rad) return false;
  }
  const Eigen::Vector2d facing{std::cos(marker.yaw_rad), std::sin(marker.yaw_rad)};
  return facing.dot(camera - marker.position_m) > 0.0;
}

LidarScan noisy_scan(const SyntheticCorridor& corridor, const TruePose& truth, Random random) {
  LidarScan scan = scan_from(corridor, truth.world_from_base, truth.time);
  for (double& range_m : scan.ranges_m) {
    if (!std::isfinite(range_m)) continue;
    range_m += random.normal(0.0, corridor.range_sigma_m);
    if (range_m > corridor.range_max_m) range_m = std::numeric_limits<double>::infinity();
  }
  return scan;
}

MarkerDetections noisy_frame(const SyntheticCorridor& corridor, const TruePose& truth,
                             Random random) {
  MarkerDetections frame{truth.time, 640, 480, {}};
  const Se2& world_from_base = truth.world_from_base;
  for (const SyntheticMarker& marker : corridor.markers) {
    const double ahead_m =
        (world_from_base.inverse() * marker.position_m).x() - corridor.camera_x_m;
    const bool is_detected = random.uniform() < detection_rate(ahead_m);
    const double range_noise_m =
        random.normal(0.0, corridor.sighting_noise * range_sigma_m(ahead_m));
    const double bearing_noise_rad =
        random.normal(0.0, corridor.sighting_noise * kBearingSigma_rad);
    const double yaw_noise_rad = random.normal(0.0, corridor.sighting_noise * kYawSigma_rad);
    if (!is_detected || !is_in_view(marker, world_from_base, corridor)) continue;
    MarkerDetection detection = detection_of(marker, world_from_base, corridor);
    Eigen::Isometry3d& pose = detection.base_from_marker;
    const Eigen::Vector3d camera{corridor.camera_x_m, 0.0, pose.translation().z()};
    Eigen::Vector3d ray = pose.translation() - camera;
    ray.x() /= 1.0 + corridor.camera_focal_error;
    const Eigen::AngleAxisd turned{bearing_noise_rad - corridor.camera_yaw_error_rad,
                                   Eigen::Vector3d::UnitZ()};
    pose.translation() = camera + turned * (ray * (1.0 + range_noise_m / ray.norm()));
    pose.linear() =
        Eigen::AngleAxisd{yaw_noise_rad - corridor.camera_yaw_error_rad, Eigen::Vector3d::UnitZ()} *
        pose.linear();
    frame.detections.push_back(detection);
  }
  return frame;
}

}  // namespace

std::vector<SyntheticMarker> opposite_markers(const SyntheticCorridor& corridor, double first_m,
                                              double spacing_m) {
  std::vector<SyntheticMarker> markers;
  const double half_m = 0.5 * corridor.width_m;
  for (double x_m = first_m; x_m < corridor.length_m - 0.5; x_m += spacing_m) {
    const int id = static_cast<int>(markers.size());
    markers.push_back({id, {x_m, half_m}, -0.5 * std::numbers::pi});
    markers.push_back({id + 1, {x_m, -half_m}, 0.5 * std::numbers::pi});
  }
  return markers;
}

LidarScan scan_from(const SyntheticCorridor& corridor, const Se2& world_from_base, Timestamp time) {
  LidarScan scan{time, {}, {}, {}};
  const Se2 world_from_lidar = world_from_base * Se2{corridor.lidar_x_m, 0.0, 0.0};
  for (int beam = 0; beam < corridor.num_beams; ++beam) {
    const double angle_rad = 2.0 * std::numbers::pi * beam / corridor.num_beams;
    const double range_m =
        ray_cast(corridor, world_from_lidar.translation(), world_from_lidar.theta() + angle_rad);
    scan.angles_rad.push_back(angle_rad);
    scan.ranges_m.push_back(
        range_m <= corridor.range_max_m ? range_m : std::numeric_limits<double>::infinity());
  }
  return scan;
}

MarkerDetection detection_of(const SyntheticMarker& marker, const Se2& world_from_base,
                             const SyntheticCorridor& corridor) {
  const Se2 base_from_marker = world_from_base.inverse() * Se2{marker.position_m, marker.yaw_rad};
  const Eigen::Vector3d facing{std::cos(base_from_marker.theta()),
                               std::sin(base_from_marker.theta()), 0.0};
  MarkerDetection detection;
  detection.id = marker.id;
  detection.base_from_marker.translation() << base_from_marker.translation(), 0.3;
  detection.base_from_marker.linear().col(2) = facing;
  detection.base_from_marker.linear().col(1) = Eigen::Vector3d::UnitZ();
  detection.base_from_marker.linear().col(0) = Eigen::Vector3d::UnitZ().cross(facing);

  const Eigen::Vector2d ray =
      base_from_marker.translation() - Eigen::Vector2d{corridor.camera_x_m, 0.0};
  const double range_m = ray.norm();
  const Eigen::Vector2d along = ray / range_m;
  const Eigen::Vector2d across{-along.y(), along.x()};
  const double sigma_along_m = 0.003 + 2.0 * range_sigma_m(ray.x());
  const double sigma_across_m = 0.002 * range_m;
  detection.covariance_in_base.setIdentity();
  detection.covariance_in_base *= 1e-4;
  detection.covariance_in_base.topLeftCorner<2, 2>() =
      sigma_along_m * sigma_along_m * along * along.transpose() +
      sigma_across_m * sigma_across_m * across * across.transpose();
  return detection;
}

SensorLog drive(const SyntheticCorridor& corridor) {
  SensorLog log;
  Random odometry_random{corridor.seed, kOdometryNoise};
  const double step_m = corridor.speed_m_s / kStepsPerSecond;
  const int steps = static_cast<int>(std::ceil(corridor.drive_m / step_m));
  Se2 world_from_base{corridor.start_x_m, 0.0, corridor.initial_heading_rad};
  Se2 odom_from_base;
  int driven = 0;  // steps
  for (int step = 0; driven <= steps; ++step) {
    const TruePose truth{time_of_step(step), world_from_base};
    log.truth.push_back(truth);
    log.odometry.push_back({truth.time, odom_from_base});
    const auto key = static_cast<std::uint64_t>(step);
    if (step % kStepsPerScan == 0) {
      log.scans.push_back(noisy_scan(corridor, truth, Random{corridor.seed, kRangeNoise, key}));
    }
    if (step % kStepsPerFrame == 0) {
      log.frames.push_back(noisy_frame(corridor, truth, Random{corridor.seed, kCameraNoise, key}));
    }
    const double driven_m = driven * step_m;
    const bool is_way_back = corridor.turn_back_every_m > 0.0 &&
                             std::fmod(driven_m / corridor.turn_back_every_m, 2.0) >= 1.0;
    const double axis_rad = is_way_back ? std::numbers::pi : 0.0;
    const bool is_turning =
        corridor.turn_back_every_m > 0.0 &&
        std::abs(angle_difference(world_from_base.theta(), axis_rad)) > kAlongAxis_rad;
    // The operator steers back to a gently winding line.
    const double wanted_rad = axis_rad + corridor.wander_rad * std::sin(driven_m / 1.7) -
                              0.5 * std::cos(axis_rad) * world_from_base.y();
    const double way_m = is_turning ? 0.0 : step_m;
    const double turn_rad =
        is_turning ? kTurn_rad_per_step
                   : 2.0 * step_m * angle_difference(wanted_rad, world_from_base.theta());
    driven += is_turning ? 0 : 1;
    world_from_base = world_from_base * Se2{way_m, 0.0, turn_rad};
    odom_from_base =
        odom_from_base *
        Se2{way_m * (1.0 + corridor.scale_error) +
                odometry_random.normal(0.0, corridor.along_noise_per_sqrt_m * std::sqrt(way_m)),
            0.0,
            turn_rad * (1.0 + corridor.turn_scale_error) +
                odometry_random.normal(0.0, corridor.turn_noise_per_sqrt_m * std::sqrt(way_m))};
  }
  return log;
}

SensorLog mirrored(const SensorLog& log) {
  const auto mirror = [](const Se2& pose) {
    return Se2{pose.x(), -pose.y(), -pose.theta()};
  };
  SensorLog result = log;
  for (OdometrySample& sample : result.odometry)
    sample.odom_from_base = mirror(sample.odom_from_base);
  for (TruePose& truth : result.truth)
    truth.world_from_base = mirror(truth.world_from_base);
  for (LidarScan& scan : result.scans) {
    for (double& angle_rad : scan.angles_rad)
      angle_rad = -angle_rad;
  }
  Eigen::Matrix<double, 6, 1> signs;
  signs << 1, -1, 1, -1, 1, -1;
  for (MarkerDetections& frame : result.frames) {
    for (MarkerDetection& detection : frame.detections) {
      // A mirror turns right into left; the marker's own x axis is turned back so that the frame
      // stays right-handed.
      const Eigen::Vector3d flip{1.0, -1.0, 1.0};
      Eigen::Isometry3d& pose = detection.base_from_marker;
      pose.translation() = flip.cwiseProduct(pose.translation());
      pose.linear() = flip.asDiagonal() * pose.linear();
      pose.linear().col(0) *= -1.0;
      detection.covariance_in_base =
          signs.asDiagonal() * detection.covariance_in_base * signs.asDiagonal();
    }
  }
  return result;
}

}  // namespace waymark::test
