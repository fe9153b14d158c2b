// SPDX-License-Identifier: BSD-3-Clause
// Odometry that says nothing: the same pose all the time.
#pragma once

#include "import/log/imported_log.hpp"

#include <optional>

namespace waymark {

/// When all poses of odometry are equal although the scans show that the robot moved: how much a
/// typical range differs from the first scan's (median over beams, of the scan that differs most).
/// nullopt when odometry moves, or the scans stay within five sigmas, too.
/// @param log  complete, with its range noise
std::optional<double> change_of_scans_while_standing_m(const ImportedLog& log);

}  // namespace waymark
