// SPDX-License-Identifier: BSD-3-Clause
// Turn of the robot between two scans, from range profiles.
#pragma once

#include "slam/core/motion/motion.hpp"
#include "slam/core/scan/annotated_scan.hpp"

#include <optional>
#include <span>

namespace waymark {

/// A turn measured by comparing range profiles.
struct TurnByScans {
  double turn_rad{0.0};
  double mismatch_m{0.0};           ///< mean difference of the ranges after that turn
  double odometry_mismatch_m{0.0};  ///< the least for turns within 3 degrees of odometry's
  /// Another turn fits the scans much better than odometry's: the wheels slipped, or the robot was
  /// turned by hand.
  bool contradicts_odometry{false};
};

/// Compares the range profile of a scan with that of an earlier one, for turns near odometry's and,
/// if these do not fit, for all turns within 50 degrees of odometry's. Coarser than matching with
/// the map, but without an initial guess; so it serves only to detect that odometry is wrong.
/// @param motion  since the earlier scan, by odometry; its translation is assumed to be correct.
/// @return none if the scans have too little in common.
std::optional<TurnByScans> turn_between(std::span<const AnnotatedBeam> earlier,
                                        std::span<const AnnotatedBeam> later, const Motion& motion);

}  // namespace waymark
