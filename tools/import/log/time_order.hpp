// SPDX-License-Identifier: BSD-3-Clause
// Times that go backwards: one bad time must not cost everything behind it.
#pragma once

#include "common/geometry/upper_median.hpp"
#include "common/time/time.hpp"
#include "import/log/import_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <span>
#include <string_view>
#include <vector>

namespace waymark {

/// For each time whether it belongs to the longest strictly ascending subsequence: what has to go
/// is as little as possible, whether single times are too early or too late. O(n log n).
std::vector<bool> longest_ascending(std::span<const Timestamp> times);

/// Messages of several processes overtake each other by as much.
inline constexpr Duration kSmallDisorder = std::chrono::milliseconds{200};

/// A step by more is of a clock that was set.
inline constexpr Duration kLongestLog = std::chrono::hours{24 * 30};

/// The order in which records have to be read so that none goes back by at most kSmallDisorder
/// behind the one before. Larger steps back stay where they are. O(n k), k records within it.
std::vector<std::size_t> order_within_tolerance(std::span<const Timestamp> times);

template <class Record>
std::vector<Timestamp> times_of(const std::vector<Record>& records) {
  std::vector<Timestamp> times;
  for (const Record& record : records)
    times.push_back(record.time);
  return times;
}

/// From each record (with a member `time`) to the next.
template <class Record>
std::vector<Duration> periods_of(const std::vector<Record>& records) {
  std::vector<Duration> periods;
  for (std::size_t i = 1; i < records.size(); ++i)
    periods.push_back(records[i].time - records[i - 1].time);
  return periods;
}

/// Puts records (with a member `time`) that are slightly out of order into order, and says so.
template <class Record>
void restore_order(std::vector<Record>& records, std::string_view what, ImportReport& report) {
  const std::vector<Timestamp> times = times_of(records);
  std::vector<Record> settled;
  std::size_t moved = 0;
  for (const std::size_t index : order_within_tolerance(times)) {
    if (index != settled.size()) ++moved;
    settled.push_back(std::move(records[index]));
  }
  records = std::move(settled);
  if (moved > 0) {
    report.note(fmt::format(
        "{}s out of order by at most {} ms: {} put in order", what,
        std::chrono::duration_cast<std::chrono::milliseconds>(kSmallDisorder).count(), moved));
  }
}

/// Times for records that have equal stamps (a step back of a millisecond at most is one, too):
/// stamps that were cut off spread over the time until the next one, records that were stamped when
/// a stalled logger went on over the time before. Order is kept; at least a microsecond apart.
/// @param stamps  as read, equal ones beside each other.
std::vector<Timestamp> spread_over_gaps(std::span<const Timestamp> stamps);

/// Spreads records (with a member `time`) that have equal stamps, and says so.
template <class Record>
void spread_equal_stamps(std::vector<Record>& records, std::string_view what,
                         ImportReport& report) {
  const std::vector<Timestamp> spread = spread_over_gaps(times_of(records));
  std::size_t moved = 0;
  for (std::size_t i = 0; i < records.size(); ++i) {
    if (records[i].time != spread[i]) ++moved;
    records[i].time = spread[i];
  }
  if (moved > 0) {
    report.note(fmt::format("{} {}s have the stamp of others: spread over the time between stamps",
                            moved, what));
  }
}

/// Removes records (with members `time` and `at`) whose time is months from the others': a clock
/// that was not set. Otherwise they would make the log that long.
template <class Record>
void remove_absurd_times(std::vector<Record>& records, std::string_view what,
                         ImportReport& report) {
  if (records.empty()) return;
  const Timestamp usual = upper_median(times_of(records));
  std::erase_if(records, [&](const Record& record) {
    if (record.time - usual < kLongestLog && usual - record.time < kLongestLog) return false;
    report.skip(
        "bad time", record.at,
        fmt::format("{} at {:.6f} s, months from the others", what, to_seconds(record.time)));
    return true;
  });
}

/// Removes records (with members `time` and `at`) out of order, naming them; more than a twentieth
/// is said with what to do.
template <class Record>
void keep_ascending(std::vector<Record>& records, std::string_view what, ImportReport& report) {
  const std::vector<Timestamp> times = times_of(records);
  const std::vector<bool> keep = longest_ascending(times);
  std::vector<Record> kept;
  for (std::size_t i = 0; i < records.size(); ++i) {
    if (keep[i]) {
      kept.push_back(std::move(records[i]));
    } else {
      report.skip("time out of order", records[i].at,
                  fmt::format("{} at {:.6f} s does not fit between the times around it", what,
                              to_seconds(times[i])));
    }
  }
  constexpr double kMany = 0.05;
  const std::size_t lost = times.size() - kept.size();
  if (static_cast<double>(lost) > kMany * static_cast<double>(times.size())) {
    report.note(fmt::format(
        "{} of {} records ({}) are out of order in time and left out: was the clock set while the "
        "log was recorded? Cut the log there, and import both parts",
        lost, times.size(), what));
  }
  records = std::move(kept);
}

}  // namespace waymark
