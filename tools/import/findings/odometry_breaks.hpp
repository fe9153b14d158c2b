// SPDX-License-Identifier: BSD-3-Clause
// Where odometry does not go on: it begins after the LiDAR, begins anew, sends single wrong poses,
// or pauses.
#pragma once

#include "import/log/imported_log.hpp"

namespace waymark {

/// Mends what scans or the samples around it show, and says each:
///  - odometry that is 0 at first and then jumps to where it counts from: joined where the scans
///  show
///    that the robot stood, else the scans before are left out;
///  - a single pose elsewhere, between two that fit each other: interpolated;
///  - odometry that begins anew while the scans show that the robot stands: goes on where it was;
///  - a pause for which slam would take the clock for set: odometry in between is interpolated.
/// A gap in the log in which the robot was moved, and odometry did not see it, is only named.
/// @param log  complete
void mend_odometry_breaks(ImportedLog& log, ImportReport& report);

}  // namespace waymark
