// SPDX-License-Identifier: BSD-3-Clause
// The log of a robot that drives straight on between two long walls with markers.
#pragma once

#include "synthetic_drive.hpp"

namespace waymark {

/// 30 m at 0.2 m/s between walls at y = +-1.5 m, with a marker every 1.5 m, alternately on the left
/// and on the right. The noise of their depth grows with its square. The description is right.
inline DoctorInput drive_in_corridor() {
  constexpr double kHalfWidth_m = 1.5;
  constexpr double kLength_m = 30.0;
  constexpr double kStep_m = 0.02;
  constexpr int kMarkers = 20;
  constexpr int kBeams = 360;
  std::mt19937 random{5};
  std::normal_distribution<double> noise{0.0, 1.0};
  DoctorInput input = described_input("corridor");
  input.log.robot = *input.described;
  input.camera.emplace();
  const Eigen::Isometry3d camera_from_base = input.described->camera.base_from_camera().inverse();
  for (int i = 0; i * kStep_m < kLength_m; ++i) {
    const double x_m = i * kStep_m;
    const Timestamp time = timestamp_from_us(10'000'000 + 100'000 * i);
    input.log.odometry.push_back({time, i, Se2{x_m, 0.0, 0.0}});
    if (i % 2 == 0) {
      planar_lidar_t scan{};
      scan.utime = to_us(time);
      scan.nranges = kBeams;
      scan.radstep = static_cast<float>(radians(1.0));
      for (int beam = 0; beam < kBeams; ++beam) {
        const double range_m = kHalfWidth_m / std::abs(std::sin(radians(beam)));
        scan.ranges.push_back(range_m < input.log.robot.lidar.range_max_m
                                  ? static_cast<float>(range_m + 0.01 * noise(random))
                                  : std::numeric_limits<float>::infinity());
      }
      input.log.scans.push_back({time, time, i, kBeams, 0.0, encode(channels::kLidar, scan), {}});
    }
    input.camera->times.push_back(time);
    for (int id = 0; id < kMarkers; ++id) {
      const double side = id % 2 == 0 ? 1.0 : -1.0;
      const Eigen::Vector3d seen =
          camera_from_base * Eigen::Vector3d{1.5 * (id + 1) - x_m, side * kHalfWidth_m, 0.3};
      if (seen.z() > 5.0 || std::abs(seen.x()) > 0.6 * seen.z()) continue;
      const Eigen::Vector3d sigmas{0.001 * seen.z(), 0.001 * seen.z(),
                                   0.0005 * seen.z() * seen.z()};
      CameraSighting sighting{.id = id, .time = time};
      for (Eigen::Index k = 0; k < 3; ++k)
        sighting.place_in_camera[k] = seen[k] + sigmas[k] * noise(random);
      sighting.covariance_in_camera = sigmas.cwiseAbs2().asDiagonal();
      sighting.facing_rad = -side * 0.5 * std::numbers::pi;
      input.camera->sightings.push_back(sighting);
    }
  }
  return input;
}

}  // namespace waymark
