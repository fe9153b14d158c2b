// SPDX-License-Identifier: BSD-3-Clause
// Times of a CARMEN log's lines: missing times, clocks that were set, lines out of order.
#pragma once

#include "import/carmen/carmen_line.hpp"
#include "import/carmen/stamps.hpp"
#include "import/log/import_report.hpp"

#include <optional>
#include <vector>

namespace waymark {

template <class Line>
struct ReadLine {
  CarmenTimes times{};
  std::int64_t at{0};
  Line line{};
  Timestamp time{};  ///< the one of `times` that is used
};

using ReadScan = ReadLine<CarmenScan>;
using ReadOdometry = ReadLine<CarmenOdometry>;

/// Leaves out lines with fewer time fields than most, because they are truncated. If most have
/// none, scans get times one period apart.
/// @param scans  not empty.
/// @throws SetupError when the log has no times, and no period is given.
void complete_times(std::vector<ReadScan>& scans, std::optional<double> scan_period_s,
                    ImportReport& report);

/// Removes steps of the clock (see find_clock_seams()), and sorts the lines if more than a tenth
/// are out of order; reports both.
/// @param scans, odometry  in the order of the file, with `time`; odometry may be empty.
void repair_order(std::vector<ReadScan>& scans, std::vector<ReadOdometry>& odometry,
                  ImportReport& report);

/// Reports scans so far apart that their times are probably milliseconds.
void check_time_unit(const std::vector<ReadScan>& scans, ImportReport& report);

}  // namespace waymark
