// SPDX-License-Identifier: BSD-3-Clause
// Detects turns of the robot that odometry did not measure.
#pragma once

#include "slam/core/motion/motion.hpp"
#include "slam/core/scan/annotated_scan.hpp"

#include <optional>
#include <span>
#include <vector>

namespace waymark {

/// Compares each scan with a reference scan from a short distance back (turn_between).
class TurnMonitor {
 public:
  /// To be called with each observation.
  /// @param beams  of its scan; none: nothing is compared.
  /// @param motion  since the previous observation, by odometry.
  /// @return scans' minus odometry's turn since the reference scan [rad], reported once; none if
  ///         the two agree or cannot be compared.
  std::optional<double> missing_turn(std::span<const AnnotatedBeam> beams, const Motion& motion);

 private:
  std::vector<AnnotatedBeam> reference_{};
  Motion since_reference_{};
};

}  // namespace waymark
