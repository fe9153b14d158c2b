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

/// Scales every range by 1 + share; results above the largest range become +inf, below the smallest
/// one NaN.
void scale_ranges(LidarScan& scan, const LidarConfig& lidar, double share);

/// Moves the pose by a random offset of up to 1 m along each axis, and makes its heading random.
void make_garbage(OdometrySample& sample, Random& random);

/// Wheels that slip: while the odometry is faulty ("wrong"), they turn by 1 + share times the angle
/// that they roll.
class SpinningWheels {
 public:
  /// The angles that the encoders measure. Call in order of time.
  /// @param angles  without slip.
  WheelPair counted(const WheelPair& angles, const Faults& odometry, const Moment& moment);

 private:
  WheelPair last_{};
  WheelPair spun_{};
};

}  // namespace waymark
