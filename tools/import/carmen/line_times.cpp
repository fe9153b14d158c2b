// SPDX-License-Identifier: BSD-3-Clause
#include "import/carmen/line_times.hpp"

#include "common/errors/setup_error.hpp"
#include "common/geometry/median.hpp"
#include "common/time/date_text.hpp"
#include "import/log/clock_seams.hpp"
#include "import/log/time_order.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

namespace waymark {
namespace {

constexpr double kFewOutOfOrder = 0.1;  // all lines are sorted if a larger share is out of order
constexpr Duration kLongPeriod = std::chrono::seconds{30};  // no scan period is longer

Timestamp after_start(double seconds) {
  return Timestamp{duration_from_seconds(seconds)};
}

std::size_t usual_num_times(const std::vector<ReadScan>& scans) {
  std::array<std::int64_t, 4> counts{};
  for (const ReadScan& scan : scans)
    ++counts.at(scan.line.num_times);
  return static_cast<std::size_t>(std::ranges::max_element(counts) - counts.begin());
}

void count_by_period(std::vector<ReadScan>& scans, std::optional<double> period_s,
                     ImportReport& report) {
  if (!period_s) {
    throw SetupError{
        "the lines have no times (the line ends before ipc_timestamp): give --scan-period-s, the "
        "time from one scan to the next (0.2 of a LiDAR of 5 Hz)"};
  }
  for (std::size_t i = 0; i < scans.size(); ++i) {
    const Timestamp time = after_start(*period_s * static_cast<double>(i));
    scans[i].times = {time, time};
  }
  report.note(fmt::format(
      "the lines have no times: scans are taken to be {:g} s apart, as asked for", *period_s));
}

/// Corrects each sample's stamp like the neighbouring scan in the file, before or after it, whose
/// stamp is nearer.
void shift_odometry(std::vector<ReadOdometry>& odometry, const std::vector<ReadScan>& scans,
                    const std::vector<Timestamp>& stamps, const std::vector<Duration>& shifts) {
  std::size_t behind = 0;  // the next scan in the file
  for (ReadOdometry& sample : odometry) {
    while (behind < scans.size() && scans[behind].at < sample.at)
      ++behind;
    const std::size_t after = std::min(behind, scans.size() - 1);
    const std::size_t before = behind > 0 ? behind - 1 : 0;
    const auto distance = [&](std::size_t i) {
      return std::chrono::abs(sample.time - stamps[i]);
    };
    sample.time += shifts[distance(before) < distance(after) ? before : after];
  }
}

void go_on_behind_seams(std::vector<ReadScan>& scans, std::vector<ReadOdometry>& odometry,
                        ImportReport& report) {
  const std::vector<Timestamp> stamps = times_of(scans);
  const std::vector<ClockSeam> seams = find_clock_seams(stamps);
  if (seams.empty() || are_pieces_in_disorder(stamps, seams)) return;
  for (const ClockSeam& seam : seams) {
    report.note(fmt::format(
        "the clock was set {} by {:.1f} s at line {}, {}: all lines are kept, "
        "and time goes on there without a step",
        seam.shift > Duration::zero() ? "back" : "ahead", std::abs(to_seconds(seam.shift)),
        scans[seam.index].at, date_text(stamps[seam.index - 1])));
  }
  const std::vector<Duration> shifts = corrections(stamps, seams);
  shift_odometry(odometry, scans, stamps, shifts);
  for (std::size_t i = 0; i < scans.size(); ++i)
    scans[i].time += shifts[i];
}

template <class Line>
void sort_by_time(std::vector<ReadLine<Line>>& lines, std::string_view what, ImportReport& report) {
  std::vector<Timestamp> settled;
  const std::vector<Timestamp> times = times_of(lines);
  for (const std::size_t index : order_within_tolerance(times))
    settled.push_back(times[index]);
  const auto in_order = std::ranges::count(longest_ascending(settled), true);
  const auto all = static_cast<double>(lines.size());
  if (static_cast<double>(in_order) >= (1.0 - kFewOutOfOrder) * all) return;
  std::vector<Timestamp> distinct = times;
  std::ranges::sort(distinct);
  distinct.erase(std::unique(distinct.begin(), distinct.end()), distinct.end());
  if (static_cast<double>(distinct.size()) < (1.0 - kFewOutOfOrder) * all) return;  // equal stamps
  std::ranges::stable_sort(lines, {}, &ReadLine<Line>::time);
  report.note(fmt::format("{} of {} {} are out of order in time: all were sorted by time",
                          static_cast<std::int64_t>(lines.size()) - in_order, lines.size(), what));
}

}  // namespace

void complete_times(std::vector<ReadScan>& scans, std::optional<double> scan_period_s,
                    ImportReport& report) {
  const std::size_t usual = usual_num_times(scans);
  std::erase_if(scans, [&](const ReadScan& scan) {
    if (scan.line.num_times >= usual) return false;
    report.skip("missing field", scan.at,
                fmt::format("the line ends with {} fields for its times, most have {}",
                            scan.line.num_times, usual));
    return true;
  });
  if (usual == 0) return count_by_period(scans, scan_period_s, report);
  if (scan_period_s) {
    report.note("the lines have times: --scan-period-s is not used");
  }
  if (usual == 1) {
    for (ReadScan& scan : scans)
      scan.times.logger = scan.times.ipc;
  }
  if (usual < 3) {
    report.note(usual == 2 ? "the lines have no ipc_hostname: left out, which costs nothing"
                           : "the lines have one time each: taken as ipc_timestamp");
  }
}

void repair_order(std::vector<ReadScan>& scans, std::vector<ReadOdometry>& odometry,
                  ImportReport& report) {
  go_on_behind_seams(scans, odometry, report);
  sort_by_time(scans, "scans", report);
  sort_by_time(odometry, "ODOM lines", report);
}

void check_time_unit(const std::vector<ReadScan>& scans, ImportReport& report) {
  if (scans.size() < 2) return;
  const Duration usual = upper_median(periods_of(scans));
  if (usual < kLongPeriod) return;
  report.note(
      fmt::format("scans are {:g} s apart: are times in ms? --time-unit ms", to_seconds(usual)));
}

}  // namespace waymark
