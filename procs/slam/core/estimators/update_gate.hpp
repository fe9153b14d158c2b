// SPDX-License-Identifier: BSD-3-Clause
// Selects the scans that update a filter.
#pragma once

#include "slam/core/motion/motion.hpp"

namespace waymark {

class Fields;

/// The errors of scans from the same place are correlated: using all of them as independent makes a
/// filter overconfident. So a scan is used only after some motion.
struct UpdateGate {
  double distance_m{0.05};
  double turn_rad{0.05};

  bool is_open(const Motion& since_last_update) const {
    return since_last_update.distance_m >= distance_m || since_last_update.turn_rad >= turn_rad;
  }

  void describe(Fields& fields);
};

}  // namespace waymark
