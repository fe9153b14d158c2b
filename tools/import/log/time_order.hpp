// SPDX-License-Identifier: BSD-3-Clause
// Handles stamps that go backwards, such that one bad stamp does not discard all records after it.
#pragma once

#include "common/geometry/median.hpp"
#include "common/time/time.hpp"
#include "import/log/import_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <span>
#include <string_view>
#include <vector>

namespace waymark {

/// True for each time of the longest strictly ascending subsequence. Removing the other records
/// removes as few as possible, whether single times are too early or too late. O(n log n).
std::vector<bool> longest_ascending(std::span<const Timestamp> times);

/// Messages of several processes may be logged out of order by this much.
inline constexpr Duration kSmallDisorder = std::chrono::milliseconds{200};

/// A larger step between stamps means that the clock was set.
inline constexpr Duration kLongestLog = std::chrono::hours{24 * 30};

/// Indices of the records sorted by time, where only records at most kSmallDisorder earlier than
/// their predecessor are moved; larger steps back stay. O(n k), k = records within kSmallDisorder.
std::vector<std::size_t> order_within_tolerance(std::span<const Timestamp> times);

template <class Record>
std::vector<Timestamp> times_of(const std::vector<Record>& records) {
  std::vector<Timestamp> times;
  for (const Record& record : records)
    times.push_back(record.time);
  return times;
}

/// Time from each record (with a member `time`) to the next.
template <class Record>
std::vector<Duration> periods_of(const std::vector<Record>& records) {
  std::vector<Duration> periods;
  for (std::size_t i = 1; i < records.size(); ++i)
    periods.push_back(records[i].time - records[i - 1].time);
  return periods;
}

/// Sorts records (with a member `time`) that are slightly out of order, with a note.
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

/// Distinct times for records with equal stamps (or a step back of at most a millisecond). Stamps
/// truncated to a coarse unit are spread over the time until the next stamp; stamps of a logger
/// that stalled and then wrote all at once, over the time before. Order is kept; results are at
/// least a microsecond apart.
/// @param stamps  as read, equal ones beside each other.
std::vector<Timestamp> spread_over_gaps(std::span<const Timestamp> stamps);

/// Applies spread_over_gaps() to records (with a member `time`), with a note.
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

/// Removes records (with members `time` and `at`) more than kLongestLog from the median: their
/// clock was not set, and the log would seem to span months.
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

/// Removes and reports records (with members `time` and `at`) out of order; a note gives advice if
/// more than 5 % are removed.
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
