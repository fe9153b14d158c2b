// SPDX-License-Identifier: BSD-3-Clause
// Times that go backwards: one bad time must not cost everything behind it.
#pragma once

#include "common/time/time.hpp"
#include "import/import_report.hpp"

#include <fmt/format.h>

#include <span>
#include <string_view>
#include <vector>

namespace waymark {

/// For each time whether it belongs to the longest strictly ascending subsequence: what has to go
/// is as little as possible, whether single times are too early or too late. O(n log n).
std::vector<bool> longest_ascending(std::span<const Timestamp> times);

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
