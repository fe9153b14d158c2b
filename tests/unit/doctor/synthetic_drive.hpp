// SPDX-License-Identifier: BSD-3-Clause
// The log of a robot that drives in a room for a minute and a half, with selectable faults.
#pragma once

#include "common/messages/codec.hpp"
#include "doctor/doctor_input.hpp"

#include <array>
#include <cmath>
#include <numbers>
#include <random>

namespace waymark {

struct DriveFaults {
  Se2 base_from_lidar{0.1, -0.05, 0.0};
  bool is_mirrored{false};
  double distance_scale{1.0};
  double turn_scale{1.0};
  double lidar_late_s{0.0};
  double no_return_m{0.0};  ///< range of beams without a return; 0 = +inf
  int dropped_scans_of_ten{0};
  bool counts_backing_as_forward{false};
  double duration_s{90.0};
  double turning{1.0};  ///< factor on turn rates; 0: straight on and back
  double focal{1.0};    ///< true / described focal length
  double marker_size{1.0};
  double camera_yaw_rad{0.0};  ///< true minus described
  double camera_late_s{0.0};
  double odometry_noise_rad{0.0};  ///< sigma of the turn in each sample
};

struct RoomMarker {
  Eigen::Vector2d place{};
  double facing_rad{0.0};
};

/// Markers on the walls below.
inline const std::array<RoomMarker, 6> kRoomMarkers{{{{5.0, -1.0}, std::numbers::pi},
                                                     {{1.0, -3.0}, 0.5 * std::numbers::pi},
                                                     {{-4.0, 1.0}, 0.0},
                                                     {{1.0, 4.0}, -0.5 * std::numbers::pi},
                                                     {{3.5, 2.5}, std::numbers::pi},
                                                     {{-1.0, 4.0}, -0.5 * std::numbers::pi}}};

/// Walls of a room of 9 m x 7 m with a pillar and a niche: x1 y1 x2 y2 [m].
inline constexpr std::array<std::array<double, 4>, 12> kRoomWalls{{{-4.0, -3.0, 5.0, -3.0},
                                                                   {5.0, -3.0, 5.0, 1.0},
                                                                   {5.0, 1.0, 3.5, 1.0},
                                                                   {3.5, 1.0, 3.5, 4.0},
                                                                   {3.5, 4.0, -4.0, 4.0},
                                                                   {-4.0, 4.0, -4.0, -3.0},
                                                                   {-2.6, 2.2, -2.0, 2.2},
                                                                   {-2.0, 2.2, -2.0, 2.8},
                                                                   {-2.0, 2.8, -2.6, 2.8},
                                                                   {-2.6, 2.8, -2.6, 2.2},
                                                                   {-4.0, -1.5, -3.0, -1.5},
                                                                   {-3.0, -1.5, -3.0, -3.0}}};

inline double range_in_room_m(const Eigen::Vector2d& from, double angle_rad) {
  const Eigen::Vector2d way{std::cos(angle_rad), std::sin(angle_rad)};
  double nearest_m = 1e9;
  for (const auto& [x1, y1, x2, y2] : kRoomWalls) {
    Eigen::Matrix2d both;
    both << way.x(), x1 - x2, way.y(), y1 - y2;
    if (std::abs(both.determinant()) < 1e-12) continue;
    const Eigen::Vector2d hit = both.inverse() * (Eigen::Vector2d{x1, y1} - from);
    if (hit.x() > 0.0 && hit.y() >= 0.0 && hit.y() <= 1.0) nearest_m = std::min(nearest_m, hit.x());
  }
  return nearest_m;
}

/// Adds the markers that a camera with 62 degrees sees from there, measured with the described
/// camera.
inline void add_sightings(CameraRecord& record, const RobotConfig& described,
                          const Se2& map_from_base, Timestamp time, const DriveFaults& faults,
                          std::mt19937& random) {
  std::normal_distribution<double> noise{0.0, 1.0};
  record.times.push_back(time);
  ++record.num_examined;
  CameraConfig camera = described.camera;
  camera.yaw_rad += faults.camera_yaw_rad;
  const Eigen::Isometry3d camera_from_base = camera.base_from_camera().inverse();
  for (std::size_t id = 0; id < kRoomMarkers.size(); ++id) {
    const RoomMarker& marker = kRoomMarkers[id];
    const Eigen::Vector2d in_base = map_from_base.inverse() * marker.place;
    const Eigen::Vector3d seen = camera_from_base * Eigen::Vector3d{in_base.x(), in_base.y(), 0.3};
    const double facing_rad = wrap_angle(marker.facing_rad - map_from_base.theta());
    const double oblique_rad = wrap_angle(facing_rad - std::atan2(-in_base.y(), -in_base.x()));
    if (seen.z() < 0.5 || std::abs(seen.x()) > 0.6 * seen.z() || std::abs(oblique_rad) > 1.1)
      continue;
    const double range_m = range_in_room_m(
        map_from_base.translation(), map_from_base.theta() + std::atan2(in_base.y(), in_base.x()));
    if (range_m < in_base.norm() - 0.05) continue;  // something stands before it
    CameraSighting sighting{.id = static_cast<int>(id), .time = time};
    const Eigen::Vector3d sigmas{0.001 * seen.z(), 0.001 * seen.z(), 0.004 * seen.z()};
    for (Eigen::Index i = 0; i < 3; ++i)
      sighting.place_in_camera[i] = seen[i] / faults.marker_size + sigmas[i] * noise(random);
    sighting.place_in_camera.z() /= faults.focal;
    sighting.covariance_in_camera = sigmas.cwiseAbs2().asDiagonal();
    sighting.facing_rad = facing_rad;
    record.sightings.push_back(sighting);
    record.blurs_px.push_back(0.7);
    record.modules_px.push_back(5.0);
    ++record.markers_of_described;
  }
}

/// An input without records, with the default description.
inline DoctorInput described_input(const char* name) {
  return {.report = {name, AddressUnit::kByte},
          .noise_is_estimated = true,
          .mounting = Mounting::kDescribed,
          .described = RobotConfig{}};
}

/// Scans of 360 beams ten times a second with 1 cm of noise, odometry fifty times a second.
inline DoctorInput drive_in_room(const DriveFaults& faults) {
  constexpr double kStep_s = 0.02;
  constexpr int kStepsPerScan = 5;
  std::mt19937 random{5};
  std::normal_distribution<double> noise{0.0, 1.0};
  DoctorInput input = described_input("drive");
  ImportedLog& log = input.log;
  log.robot.lidar.x_m = 0.1;
  log.robot.lidar.y_m = -0.05;
  log.robot.lidar.range_max_m = 20.0;
  input.described->lidar = log.robot.lidar;
  input.channels["LIDAR"] = {900, 1'000'000, 1500, 0.0, faults.duration_s};
  input.recorded_s = faults.duration_s;
  input.lidar_channel = "LIDAR";
  input.camera.emplace();
  Se2 pose{};
  Se2 odometry{};
  const int steps = static_cast<int>(faults.duration_s / kStep_s);
  for (int i = 0; i < steps; ++i) {
    const double t = i * kStep_s;
    const Timestamp time = timestamp_from_us(10'000'000 + 20'000 * i);
    log.odometry.push_back({time, i, odometry});
    if (i % kStepsPerScan == 0 && static_cast<int>(random() % 10) >= faults.dropped_scans_of_ten) {
      const Se2 lidar = pose * faults.base_from_lidar;
      planar_lidar_t message{};
      message.utime = to_us(time + duration_from_seconds(faults.lidar_late_s));
      message.nranges = 360;
      message.rad0 = static_cast<float>(-std::numbers::pi);
      message.radstep = static_cast<float>(radians(1.0));
      for (int beam = 0; beam < message.nranges; ++beam) {
        const double angle_rad =
            (faults.is_mirrored ? -1.0 : 1.0) * (-std::numbers::pi + radians(beam));
        const double range_m = range_in_room_m(lidar.translation(), lidar.theta() + angle_rad);
        const bool returns = random() % 40 != 0;
        message.ranges.push_back(returns ? static_cast<float>(range_m + 0.01 * noise(random))
                                 : faults.no_return_m > 0.0
                                     ? static_cast<float>(faults.no_return_m)
                                     : std::numeric_limits<float>::infinity());
      }
      const Timestamp stamp = timestamp_from_us(message.utime);
      log.scans.push_back(
          {stamp, stamp, i, message.nranges, 0.0, encode(channels::kLidar, message), {}});
    }
    if (i % kStepsPerScan == 0) {
      add_sightings(*input.camera, *input.described, pose,
                    time + duration_from_seconds(faults.camera_late_s), faults, random);
    }
    // The robot drives ahead and back, with turns that start and stop.
    const double speed_m_s = 0.4 * std::sin(0.45 * t);
    const double turn_rad_s =
        faults.turning * 0.9 * std::sin(0.7 * t) * (std::sin(0.23 * t) > 0.0 ? 1.0 : 0.4);
    const Se2 motion{speed_m_s * kStep_s, 0.0, turn_rad_s * kStep_s};
    pose = pose * motion;
    const double turn_noise_rad =
        faults.odometry_noise_rad > 0.0 ? faults.odometry_noise_rad * noise(random) : 0.0;
    const bool is_wrong = faults.counts_backing_as_forward && speed_m_s < 0.0;
    odometry = odometry * Se2{(is_wrong ? -1.0 : 1.0) * faults.distance_scale * motion.x(), 0.0,
                              faults.turn_scale * motion.theta() + turn_noise_rad};
  }
  // Keeps scans within the times of odometry, as the importer does.
  std::erase_if(log.scans, [&](const ImportedScan& scan) {
    return scan.time < log.odometry.front().time || scan.time > log.odometry.back().time;
  });
  return input;
}

}  // namespace waymark
