// SPDX-License-Identifier: BSD-3-Clause
// Motion model of particle filters: samples of an odometry increment with noise (the paper, IV-B).
#pragma once

#include "common/random/random.hpp"
#include "slam/core/motion/motion.hpp"

namespace waymark {

class Fields;

/// All noise is a random walk along the path: its variance grows with distance and turn, so it does
/// not depend on how many steps the path is divided into.
struct MotionNoise {
  double along_per_sqrt_m{0.01};
  double turn_per_sqrt_m{0.0087};
  double turn_per_sqrt_rad{0.02};
  bool rotation_only{false};

  /// Names, units and explanations of the keys: core_fields.cpp.
  void describe(Fields& fields);
};

/// One sample of start_from_end.
Se2 sample_motion(const Motion& motion, const MotionNoise& noise, Random& random);

}  // namespace waymark
