// SPDX-License-Identifier: BSD-3-Clause
// A planar LiDAR: rays against the walls of the physics model.
#pragma once

#include "common/config/config.hpp"
#include "common/robot/robot_config.hpp"
#include "common/sensors/sensors.hpp"
#include "sim/core/robot/physics.hpp"

#include <cstdint>

namespace waymark {

/// True noise of the simulated ranges; the noise that slam assumes is robot.lidar.range_sigma_m.
struct LidarNoiseConfig {
  double range_sigma_m{0.01};
  double dropout_probability{0.005};

  void describe(Fields& fields);
};

/// Measures beams one by one, so that a sweep can be taken while the robot moves.
class Lidar {
 public:
  Lidar(const LidarConfig& config, const LidarNoiseConfig& noise, std::int64_t seed);

  /// A whole sweep at one instant.
  LidarScan scan(Timestamp time, const Physics& physics);

  /// Appends the next `count` beams of a sweep, measured from the robot's present pose. Angles
  /// increase from the LiDAR's x axis; a mirrored LiDAR turns clockwise, but gives its beams the
  /// same angles. A sweep is complete with config().num_beams beams.
  void add_beams(LidarScan& scan, int count, const Physics& physics);

  const LidarConfig& config() const { return config_; }

 private:
  double measured_m(double true_range_m);

  LidarConfig config_;
  LidarNoiseConfig noise_;
  std::uint64_t seed_;
  std::uint64_t beam_{0};  ///< number of beams measured so far in the run; selects the noise
};

/// Distance to the first wall or box along a direction in the world frame; +inf when there is none.
double wall_distance_m(const Physics& physics, const Eigen::Vector3d& from_m,
                       const Eigen::Vector3d& direction);

}  // namespace waymark
