// SPDX-License-Identifier: BSD-3-Clause
// Detects turns of the robot that its wheels did not measure.
#pragma once

#include "slam/core/motion/motion.hpp"
#include "slam/core/scan/annotated_scan.hpp"

#include <optional>
#include <span>
#include <vector>

namespace waymark {

/// Finds turns that odometry misses, scan by scan: each is compared with one from a short way
/// before (turn_between).
class TurnMonitor {
 public:
  /// The next observation.
  /// @param beams  of its scan; none: nothing is compared.
  /// @param motion  since the observation before, by odometry.
  /// @return [rad] turn beyond odometry's, once; nothing where odometry is plausible.
  std::optional<double> missing_turn(std::span<const AnnotatedBeam> beams, const Motion& motion);

 private:
  std::vector<AnnotatedBeam> reference_{};
  Motion since_reference_{};
};

}  // namespace waymark
