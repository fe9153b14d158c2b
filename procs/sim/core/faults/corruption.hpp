// SPDX-License-Identifier: BSD-3-Clause
// Values of measurements that are garbage or wrong.
#pragma once

#include "common/random/random.hpp"
#include "common/robot/robot_config.hpp"
#include "common/sensors/sensors.hpp"
#include "sim/core/faults/fault_config.hpp"
#include "sim/core/robot/physics.hpp"

namespace waymark {

/// Every range anything that the LiDAR can measure.
void make_garbage(LidarScan& scan, const LidarConfig& lidar, Random& random);

/// Every range too long by a share; what is beyond the greatest range has no return.
void scale_ranges(LidarScan& scan, const LidarConfig& lidar, double share);

/// A pose within a metre of the right one, heading anywhere.
void make_garbage(OdometrySample& sample, Random& random);

/// Wheels that turn further than they roll: what the encoders count.
class SpinningWheels {
 public:
  /// @param angles  of the wheels as they roll; call in order of time.
  WheelPair counted(const WheelPair& angles, const Faults& odometry, const Moment& moment);

 private:
  WheelPair last_{};
  WheelPair spun_{};
};

}  // namespace waymark
