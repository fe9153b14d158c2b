// SPDX-License-Identifier: BSD-3-Clause
// Unit tests of which values of a sensor wait, and which are found to be stamped wrong.
#include "slam/core/input/stamped_queue.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace waymark {
namespace {

struct Value {
  Timestamp time{};
};

constexpr QueuePolicy kPolicy{.capacity = 4,
                              .max_age = Duration::max(),
                              .out_of_order = Skip::kScanOutOfOrder,
                              .ahead = Skip::kScanAhead,
                              .overflow = Skip::kScanOverflow};

struct Result {
  std::vector<int> seconds{};  ///< of what is in the queue, in order
  std::vector<Skip> skips{};

  bool operator==(const Result&) const = default;
};

Timestamp at_s(int seconds) {
  return Timestamp{std::chrono::seconds{seconds}};
}

Result result_of(const std::vector<int>& seconds) {
  StampedQueue<Value> queue{kPolicy};
  Skips skips;
  for (const int time_s : seconds)
    queue.add({at_s(time_s)}, skips);
  Result result;
  while (!queue.is_empty())
    result.seconds.push_back(static_cast<int>(to_us(queue.pop().time) / 1'000'000));
  result.skips = skips.take();
  return result;
}

TEST(StampedQueue, ValuesInOrderAreKept) {
  EXPECT_EQ(result_of({1, 2, 3}), (Result{{1, 2, 3}, {}}));
}

TEST(StampedQueue, AValueStampedTooEarlyIsDroppedOnceTheNextOneIsNewerThanAll) {
  EXPECT_EQ(result_of({5, 6, 2}), (Result{{5, 6}, {}})) << "it may yet be right";
  EXPECT_EQ(result_of({5, 6, 2, 7}), (Result{{5, 6, 7}, {Skip::kScanOutOfOrder}}));
}

TEST(StampedQueue, ValuesStampedAheadAreDroppedOnceTwoOlderOnesFollow) {
  EXPECT_EQ(result_of({1, 2, 60, 61, 3, 4}),
            (Result{{1, 2, 3, 4}, {Skip::kScanAhead, Skip::kScanAhead}}));
}

TEST(StampedQueue, ASecondValueWithTheNewestStampIsDropped) {
  EXPECT_EQ(result_of({1, 2, 2, 3}), (Result{{1, 2, 3}, {Skip::kScanOutOfOrder}}));
}

TEST(StampedQueue, BeyondTheCapacityTheOldestValueIsDropped) {
  EXPECT_EQ(result_of({1, 2, 3, 4, 5, 6}),
            (Result{{3, 4, 5, 6}, {Skip::kScanOverflow, Skip::kScanOverflow}}));
}

TEST(StampedQueue, ValuesMuchOlderThanTheNewestAreDropped) {
  QueuePolicy policy = kPolicy;
  policy.max_age = std::chrono::seconds{20};
  StampedQueue<Value> queue{policy};
  Skips skips;
  for (const int time_s : {1, 15, 21, 22})
    queue.add({at_s(time_s)}, skips);
  EXPECT_EQ(skips.take(), (std::vector<Skip>{Skip::kScanOverflow}));
  EXPECT_EQ(queue.front().time, at_s(15));
}

TEST(StampedQueue, ClearingCountsPendingValuesAndAcceptsOlderStampsAgain) {
  StampedQueue<Value> queue{kPolicy};
  Skips skips;
  for (const int time_s : {5, 6, 2})
    queue.add({at_s(time_s)}, skips);
  queue.clear(skips);
  EXPECT_EQ(skips.take().size(), 3U);
  EXPECT_FALSE(queue.has_reached(at_s(1)));
  queue.add({at_s(1)}, skips);
  EXPECT_FALSE(queue.is_empty());
  EXPECT_TRUE(skips.take().empty());
}

TEST(StampedQueue, AHeldValueIsAddedOnceItsStampIsReached) {
  StampedQueue<Value> queue{kPolicy};
  Skips skips;
  queue.hold({at_s(30)}, skips);
  EXPECT_TRUE(queue.is_empty());
  queue.add_held(at_s(30), skips);
  EXPECT_EQ(to_us(queue.front().time), 30'000'000);
  EXPECT_TRUE(skips.take().empty());
}

TEST(StampedQueue, OfHeldValuesAllButTheNewestAreDropped) {
  StampedQueue<Value> queue{kPolicy};
  Skips skips;
  queue.hold({at_s(30)}, skips);
  queue.hold({at_s(31)}, skips);
  queue.add_held(at_s(10), skips);
  queue.drop_held(skips);
  EXPECT_TRUE(queue.is_empty());
  EXPECT_EQ(skips.take(), (std::vector<Skip>{Skip::kScanAhead, Skip::kScanAhead}));
}

TEST(StampedQueue, ValuesStampedAfterAGivenTimeAreDropped) {
  StampedQueue<Value> queue{kPolicy};
  Skips skips;
  for (const int time_s : {1, 9})
    queue.add({at_s(time_s)}, skips);
  queue.drop_after(at_s(5), skips);
  EXPECT_EQ(skips.take(), std::vector<Skip>{Skip::kScanAhead});
  queue.add({at_s(2)}, skips);
  EXPECT_EQ(to_us(queue.pop().time), 1'000'000);
  EXPECT_EQ(to_us(queue.pop().time), 2'000'000);
}

}  // namespace
}  // namespace waymark
