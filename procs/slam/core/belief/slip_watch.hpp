// SPDX-License-Identifier: BSD-3-Clause
// Tells a wheel that slips from the noise of the odometry, by the turns that walls correct.
#pragma once

#include "slam/core/belief/noise_growth.hpp"
#include "slam/core/motion/motion.hpp"

namespace waymark {

/// A turn that is off by far more than turns have been off so far is no noise.
class SlipWatch {
 public:
  /// By how much a slip has turned the odometry [rad], where the correction of an update shows one;
  /// else 0. Where the wheels of a robot go both ways, it turns on the spot, and what a slip costs
  /// there is not along its way: 0, too.
  double slipped_turn(const PoseCorrection& correction, const Motion& motion,
                      const OdometryNoise& noise) const;

  /// Odometry may be worse than it is told to be: corrections that show no slip say how much.
  void learn(const PoseCorrection& correction, const Motion& motion, const OdometryNoise& noise);

 private:
  double ratio_{1.0};  ///< of squared corrections to what is expected of them
};

}  // namespace waymark
