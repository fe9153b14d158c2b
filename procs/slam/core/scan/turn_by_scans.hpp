// SPDX-License-Identifier: BSD-3-Clause
// How far the robot turned between two scans, by the scans alone.
#pragma once

#include "slam/core/motion/motion.hpp"
#include "slam/core/scan/annotated_scan.hpp"

#include <optional>
#include <span>

namespace waymark {

/// A turn that is measured by range profiles.
struct TurnByScans {
  double turn_rad{0.0};
  double mismatch_m{0.0};           ///< mean difference of the ranges after that turn
  double odometry_mismatch_m{0.0};  ///< the same after odometry's turn
  /// Odometry's turn does not fit the scans at all, and another one does: the wheels slipped or the
  /// robot was turned by hand.
  bool contradicts_odometry{false};
};

/// Compares the range profile of a scan with that of an earlier one, for all turns within 50
/// degrees of the odometry's, or just near to that if it fits. It takes part in no estimate as long
/// as odometry is plausible: it is coarser than matching with the map, but has no basin of
/// attraction to miss.
/// @param motion  since the earlier scan, by odometry; its way is taken for right.
/// @return nothing when the scans have too little in common.
std::optional<TurnByScans> turn_between(std::span<const AnnotatedBeam> earlier,
                                        std::span<const AnnotatedBeam> later, const Motion& motion);

}  // namespace waymark
