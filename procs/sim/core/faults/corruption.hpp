// SPDX-License-Identifier: BSD-3-Clause
// Fault kinds that change measured values: garbage and wrong.
#pragma once

#include "common/random/random.hpp"
#include "common/robot/robot_config.hpp"
#include "common/sensors/sensors.hpp"
#include "sim/core/faults/fault_config.hpp"
#include "sim/core/robot/physics.hpp"

namespace waymark {

/// Replaces every range by a random one within the LiDAR's limits.
void make_garbage(LidarScan& scan, const LidarConfig& lidar, Random& random);

/// Scales every range by 1 + share; results above lidar.range_max_m become +inf, results below
/// lidar.range_min_m become NaN.
void scale_ranges(LidarScan& scan, const LidarConfig& lidar, double share);

/// Adds a random offset in [-1, 1] m to x and to y, and replaces the heading by a random one.
void make_garbage(OdometrySample& sample, Random& random);

/// Encoders of wheels that spin: while a fault "wrong" of the odometry is active, they count
/// 1 + share times the angle by which the wheel rolls; what they counted in excess is kept.
class SpinningWheels {
 public:
  /// The angles that the encoders count. Call in order of time.
  /// @param angles  true angles of the wheels since the start.
  WheelPair counted(const WheelPair& angles, const Faults& odometry, const Moment& moment);

 private:
  WheelPair last_{};
  WheelPair spun_{};
};

}  // namespace waymark
