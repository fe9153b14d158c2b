// SPDX-License-Identifier: BSD-3-Clause
// Selects the scans that GMapping processes; the others only move the particles.
#pragma once

#include "common/time/time.hpp"
#include "slam/core/motion/motion.hpp"

namespace waymark {

class Fields;

struct ScanGate {
  double linear_update_m{1.0};
  double angular_update_rad{0.5};
  double temporal_update_s{-1.0};

  bool is_open(const Motion& since_update, Duration elapsed) const {
    return since_update.distance_m >= linear_update_m ||
           since_update.turn_rad >= angular_update_rad ||
           (temporal_update_s >= 0.0 && to_seconds(elapsed) > temporal_update_s);
  }

  /// Names, units and explanations of the keys: core_fields.cpp.
  void describe(Fields& fields);
};

}  // namespace waymark
