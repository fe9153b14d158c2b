// SPDX-License-Identifier: BSD-3-Clause
// Repairs discontinuities of odometry: a late start, restarts, single wrong poses, long pauses.
#pragma once

#include "import/log/imported_log.hpp"

namespace waymark {

/// Repairs, with a note for each:
///  - odometry that is 0 at first and then jumps: joined if the scans show that the robot stood,
///    else the scans before the jump are left out;
///  - a single wrong pose between two consistent ones: interpolated;
///  - odometry that begins anew while the scans show that the robot stands: continued;
///  - a pause so long that slam would assume that the clock was set: interpolated.
/// A gap in the log in which the robot was moved is only reported.
/// @param log  after make_consistent().
void repair_odometry_breaks(ImportedLog& log, ImportReport& report);

}  // namespace waymark
