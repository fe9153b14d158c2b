// SPDX-License-Identifier: BSD-3-Clause
#include "import/log/time_order.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <random>

namespace waymark {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

std::vector<Timestamp> times(std::initializer_list<std::int64_t> times_us) {
  std::vector<Timestamp> result;
  for (const std::int64_t time_us : times_us)
    result.push_back(timestamp_from_us(time_us));
  return result;
}

TEST(LongestAscending, KeepsAscendingTimes) {
  EXPECT_THAT(longest_ascending(times({1, 2, 5})), ElementsAre(true, true, true));
  EXPECT_THAT(longest_ascending({}), IsEmpty());
}

TEST(LongestAscending, OneTimeTooLateRemovesOnlyItself) {
  EXPECT_THAT(longest_ascending(times({1, 900, 2, 3})), ElementsAre(true, false, true, true));
}

TEST(LongestAscending, OneTimeTooEarlyRemovesOnlyItself) {
  EXPECT_THAT(longest_ascending(times({5, 6, 1, 7})), ElementsAre(true, true, false, true));
}

TEST(LongestAscending, EqualTimesDoNotAscend) {
  const auto keep = longest_ascending(times({4, 4, 4}));
  EXPECT_EQ(std::ranges::count(keep, true), 1);
}

struct Record {
  Timestamp time{};
  std::int64_t at{0};
};

TEST(KeepAscending, ALossOfTenRecordsIsNotedAndOfOneIsNot) {
  for (const std::int64_t late : {1, 10}) {
    std::vector<Record> records;
    for (std::int64_t i = 0; i < 100; ++i)
      records.push_back({timestamp_from_us(i < late ? 1'000 + i : i), i});
    ImportReport report{"log", AddressUnit::kByte};

    keep_ascending(records, "a scan", report);

    EXPECT_EQ(report.num_skipped(), late);
    EXPECT_EQ(report.notes().size(), late > 5 ? 1U : 0U);
  }
}

TEST(SpreadOverGaps, TruncatedStampsAreSpreadUntilTheNextOne) {
  EXPECT_EQ(spread_over_gaps(times({100, 100, 200, 200, 300, 300})),
            times({100, 150, 200, 250, 275, 300}));
}

TEST(SpreadOverGaps, ABurstAfterAStallIsSpreadOverTheStall) {
  EXPECT_EQ(spread_over_gaps(times({100, 200, 600, 600, 600, 600, 700})),
            times({100, 200, 300, 400, 500, 600, 700}));
}

TEST(SpreadOverGaps, APauseWithoutRecordsIsKept) {
  EXPECT_EQ(spread_over_gaps(times({100, 100, 60'000'100})), times({100, 1'000'100, 60'000'100}));
}

TEST(SpreadOverGaps, DistinctStampsAreUnchanged) {
  EXPECT_EQ(spread_over_gaps(times({5, 7, 6'000'000, 9})), times({5, 7, 6'000'000, 9}));
}

TEST(OrderWithinTolerance, SlightlyDisorderedRecordsAreSorted) {
  EXPECT_THAT(order_within_tolerance(times({1, 2, 3})), ElementsAre(0, 1, 2));
  EXPECT_THAT(order_within_tolerance(times({1000, 150'900, 150'000, 300'000, 290'000, 280'000})),
              ElementsAre(0, 2, 1, 5, 4, 3));
  EXPECT_THAT(order_within_tolerance(times({5, 5, 5})), ElementsAre(0, 1, 2))
      << "equal ones keep theirs";
}

TEST(OrderWithinTolerance, ALargeStepBackIsKept) {
  EXPECT_THAT(order_within_tolerance(times({1'000'000, 2'000'000, 1'500'000})),
              ElementsAre(0, 1, 2));
}

/// Length of the longest ascending subsequence, found by trying all subsequences.
int slow_length(const std::vector<Timestamp>& all) {
  int best = 0;
  for (unsigned subset = 0; subset < (1U << all.size()); ++subset) {
    std::vector<Timestamp> chosen;
    for (std::size_t i = 0; i < all.size(); ++i) {
      if ((subset >> i) & 1U) chosen.push_back(all[i]);
    }
    const bool ascends = std::ranges::adjacent_find(chosen, std::greater_equal{}) == chosen.end();
    if (ascends) best = std::max(best, static_cast<int>(chosen.size()));
  }
  return best;
}

TEST(LongestAscending, IsAsLongAsTheBestOfAllSubsets) {
  std::mt19937 random{7};
  for (int trial = 0; trial < 100; ++trial) {
    std::vector<Timestamp> all(random() % 10);
    std::ranges::generate(all, [&] { return timestamp_from_us(random() % 12); });
    const auto keep = longest_ascending(all);
    std::vector<Timestamp> kept;
    for (std::size_t i = 0; i < all.size(); ++i) {
      if (keep[i]) kept.push_back(all[i]);
    }
    EXPECT_EQ(std::ranges::adjacent_find(kept, std::greater_equal{}), kept.end());
    EXPECT_EQ(static_cast<int>(kept.size()), slow_length(all));
  }
}

}  // namespace
}  // namespace waymark
