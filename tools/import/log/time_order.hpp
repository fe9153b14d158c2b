// SPDX-License-Identifier: BSD-3-Clause
// Times that go backwards: one bad time must not cost everything behind it.
#pragma once

#include "common/time/time.hpp"
#include "import/log/import_report.hpp"

#include <fmt/format.h>

#include <span>
#include <string_view>
#include <vector>

namespace waymark {

/// For each time whether it belongs to the longest strictly ascending subsequence: what has to go
/// is as little as possible, whether single times are too early or too late. O(n log n).
std::vector<bool> longest_ascending(std::span<const Timestamp> times);

/// Messages of several processes overtake each other by as much.
inline constexpr Duration kSmallDisorder = std::chrono::milliseconds{200};

/// The order in which records have to be read so that none goes back by at most kSmallDisorder
/// behind the one before. Larger steps back stay where they are. O(n k), k records within it.
std::vector<std::size_t> settled_order(std::span<const Timestamp> times);

/// Puts records (with a member `time`) that are slightly out of order into order, and says so.
template <class Record>
void settle_small_disorder(std::vector<Record>& records, std::string_view what,
                           ImportReport& report) {
  std::vector<Timestamp> times;
  for (const Record& record : records)
    times.push_back(record.time);
  std::vector<Record> settled;
  std::size_t moved = 0;
  for (const std::size_t index : settled_order(times)) {
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

/// Removes records (with members `time` and `at`) out of order, naming them.
template <class Record>
void keep_ascending(std::vector<Record>& records, std::string_view what, ImportReport& report) {
  std::vector<Timestamp> times;
  for (const Record& record : records)
    times.push_back(record.time);
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
  records = std::move(kept);
}

}  // namespace waymark
