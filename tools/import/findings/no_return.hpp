// SPDX-License-Identifier: BSD-3-Clause
// The range that a LiDAR's driver writes when nothing returns.
#pragma once

#include "import/log/imported_log.hpp"

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace waymark {

/// Ranges that say "no return", as found among the ranges of a log.
struct NoReturnCode {
  std::vector<double> codes_m{};  ///< ascending; a SICK has several
  std::int64_t count{0};          ///< ranges of the smallest code or more, of these scans
};

/// A range is such a code when it piles up (ten times as often as what is up to a fifth shorter,
/// and twenty times at least), when nearly nothing is longer, and when the beams beside it are not
/// a bit shorter: a wall, also before a standing robot, goes on in its neighbours, a code ends at
/// an edge.
/// @param scans  of distinct places, so that what a standing robot sees does not pile up
std::optional<NoReturnCode> find_no_return_code(std::span<const LidarScan> scans);

/// Longest range that counts as one.
struct RangeLimit {
  std::optional<double> given_m{};  ///< by the user: nothing is looked for
  std::optional<double> usual_m{};  ///< of this kind of LiDAR; nullopt = the longest that is seen
};

/// Finds the code, makes no return (+inf, in lidar_t 0) of it and of all longer ranges, and 0 of
/// planar_lidar_t, which is no distance, NaN; writes the robot's range_max_m, and says what was
/// found.
/// @param log  complete
/// @throws SetupError when there is no limit, and no beam has a range
void mark_no_returns(ImportedLog& log, const RangeLimit& limit, ImportReport& report);

}  // namespace waymark
