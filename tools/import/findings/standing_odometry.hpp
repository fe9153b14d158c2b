// SPDX-License-Identifier: BSD-3-Clause
// Odometry that never moves.
#pragma once

#include "import/log/imported_log.hpp"

#include <optional>

namespace waymark {

/// If all poses of odometry are equal although the scans change: the change [m] of a typical range
/// from the first scan (median over beams, of the scan that differs most). nullopt when odometry
/// moves, or the scans stay within five sigmas.
/// @param log  after make_consistent(), with its range noise.
std::optional<double> change_of_scans_while_standing_m(const ImportedLog& log);

}  // namespace waymark
