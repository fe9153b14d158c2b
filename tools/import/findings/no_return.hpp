// SPDX-License-Identifier: BSD-3-Clause
// The range that a LiDAR's driver writes for "no return".
#pragma once

#include "import/log/imported_log.hpp"

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace waymark {

/// Ranges that stand for "no return", as found in a log.
struct NoReturnCode {
  std::vector<double> codes_m{};  ///< ascending; a SICK has several
  std::int64_t count{0};          ///< number of ranges at or above the smallest of codes_m
};

/// A range is such a code if it occurs at least 20 times, on at least ten beams, and ten times as
/// often as ranges up to a fifth shorter, if nearly no range is longer, and if neighbouring beams
/// are rarely slightly shorter: on a wall, neighbours have similar ranges; beside a code, they
/// differ.
/// @param scans  of distinct places: the scans of a standing robot would pile up, too.
std::optional<NoReturnCode> find_no_return_code(std::span<const LidarScan> scans);

/// Largest valid range.
struct RangeLimit {
  std::optional<double> given_m{};  ///< set by the user; then no code is searched for
  std::optional<double> usual_m{};  ///< usual for this kind of LiDAR; nullopt = the longest range
};

/// Finds the code, replaces it and all longer ranges by "no return" (+inf, in lidar_t 0), and a
/// range 0 of planar_lidar_t by NaN; sets the robot's range_max_m, and reports what was found.
/// @param log  after make_consistent().
/// @throws SetupError when no beam has a range below the limit.
void mark_no_returns(ImportedLog& log, const RangeLimit& limit, ImportReport& report);

}  // namespace waymark
