// SPDX-License-Identifier: BSD-3-Clause
// When the lines of a CARMEN log were measured: lines without times, clocks that were set, lines in
// another order than their times.
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
  Timestamp time{};  ///< the one of both that is taken
};

using ReadScan = ReadLine<CarmenScan>;
using ReadOdometry = ReadLine<CarmenOdometry>;

/// Leaves out lines that have fewer fields for their times than most: they are cut off. Where most
/// have none, the scans are a period apart.
/// @param scans  not empty
/// @throws SetupError when the log has no times, and no period is given.
void complete_times(std::vector<ReadScan>& scans, std::optional<double> scan_period_s,
                    ImportReport& report);

/// Goes on counting where the clock was set (see find_clock_seams()), and sorts lines of which more
/// than a tenth would be out of order; says both.
/// @param scans, odometry  in the order of the file, with `time`; odometry may be empty
void mend_order(std::vector<ReadScan>& scans, std::vector<ReadOdometry>& odometry,
                ImportReport& report);

/// Scans that are so far apart that their times are likely to be milliseconds are named.
void check_time_unit(const std::vector<ReadScan>& scans, ImportReport& report);

}  // namespace waymark
