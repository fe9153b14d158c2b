// SPDX-License-Identifier: BSD-3-Clause
#include "slam/core/scan/turn_monitor.hpp"

#include "common/geometry/angle.hpp"
#include "slam/core/scan/turn_by_scans.hpp"

namespace waymark {
namespace {

// Motion after which the reference scan is replaced. After more, other objects come into sight;
// after less, a turn cannot be distinguished from noise.
constexpr double kReplaced_m = 0.2;
constexpr double kReplaced_rad = 0.35;

}  // namespace

std::optional<double> TurnMonitor::missing_turn(std::span<const AnnotatedBeam> beams,
                                                const Motion& motion) {
  since_reference_ = since_reference_.then(motion);
  if (beams.empty()) return std::nullopt;
  std::optional<double> missing_rad;
  const auto by_scans = turn_between(reference_, beams, since_reference_);
  if (by_scans && by_scans->contradicts_odometry)
    missing_rad = angle_difference(by_scans->turn_rad, since_reference_.start_from_end.theta());
  if (reference_.empty() || missing_rad || since_reference_.distance_m >= kReplaced_m ||
      since_reference_.turn_rad >= kReplaced_rad) {
    reference_.assign(beams.begin(), beams.end());
    since_reference_ = {};
  }
  return missing_rad;
}

}  // namespace waymark
