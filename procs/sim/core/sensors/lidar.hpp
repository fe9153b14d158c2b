// SPDX-License-Identifier: BSD-3-Clause
// A planar LiDAR: rays against the walls of the physics model.
#pragma once

#include "common/config/config.hpp"
#include "common/robot/robot_config.hpp"
#include "common/sensors/sensors.hpp"
#include "sim/core/robot/physics.hpp"

#include <cstdint>

namespace waymark {

/// Errors of the ranges beyond the noise that the robot's description states.
struct LidarNoiseConfig {
  double range_sigma_m{0.01};
  double dropout_probability{0.005};

  void describe(Fields& fields);
};

/// Measures beams one by one, so that a sweep can be taken while the robot moves.
class Lidar {
 public:
  Lidar(const LidarConfig& config, const LidarNoiseConfig& noise, std::int64_t seed);

  /// A whole sweep from one place, at one time.
  LidarScan scan(Timestamp time, const Physics& physics);

  /// The next beams of a sweep, from where the robot is now. Angles count from the x axis,
  /// counter-clockwise (of a mirrored LiDAR in truth clockwise, which the scan does not say); the
  /// sweep is complete when it has config().num_beams.
  void add_beams(LidarScan& scan, int count, const Physics& physics);

  const LidarConfig& config() const { return config_; }

 private:
  double measured_m(double true_range_m);

  LidarConfig config_;
  LidarNoiseConfig noise_;
  std::uint64_t seed_;
  std::uint64_t beam_{0};  ///< of the whole run: key of the noise
};

/// Distance to the first wall along a direction in the world; infinite when there is none.
double wall_distance_m(const Physics& physics, const Eigen::Vector3d& from_m,
                       const Eigen::Vector3d& direction);

}  // namespace waymark
