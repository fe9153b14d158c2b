// SPDX-License-Identifier: BSD-3-Clause
// Which scans are worth an update.
#pragma once

#include "slam/core/motion/motion.hpp"

namespace waymark {

class Fields;

/// Scans from the same place repeat the same errors: weighing them as if they were independent
/// makes a filter overconfident. So a scan counts only after some motion.
struct UpdateGate {
  double distance_m{0.05};
  double turn_rad{0.05};

  bool is_open(const Motion& since_last_update) const {
    return since_last_update.distance_m >= distance_m || since_last_update.turn_rad >= turn_rad;
  }

  void describe(Fields& fields);
};

}  // namespace waymark
