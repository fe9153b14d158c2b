// SPDX-License-Identifier: BSD-3-Clause
// Unit tests of periods of message time.
#include "slam/period.hpp"

#include <gtest/gtest.h>

#include <chrono>

namespace waymark {
namespace {

Timestamp after_s(int seconds) {
  return Timestamp{std::chrono::seconds{seconds}};
}

TEST(Period, IsDueOncePerPeriod) {
  Period period{10.0, Period::First::kAtOnce};
  EXPECT_TRUE(period.is_due(after_s(100)));
  EXPECT_FALSE(period.is_due(after_s(109)));
  EXPECT_TRUE(period.is_due(after_s(110)));
  EXPECT_FALSE(period.is_due(after_s(119)));
}

TEST(Period, TheFirstTimeMayBeDueOnlyAfterAPeriod) {
  Period period{10.0, Period::First::kAfterAPeriod};
  EXPECT_FALSE(period.is_due(after_s(100)));
  EXPECT_FALSE(period.is_due(after_s(109)));
  EXPECT_TRUE(period.is_due(after_s(110)));
}

TEST(Period, BeginsAgainWhenTheClockIsSetBack) {
  Period at_once{10.0, Period::First::kAtOnce};
  Period after_a_period{10.0, Period::First::kAfterAPeriod};
  at_once.is_due(after_s(100));
  after_a_period.is_due(after_s(100));
  EXPECT_FALSE(at_once.is_due(after_s(100)));
  EXPECT_TRUE(at_once.is_due(after_s(50)));
  EXPECT_FALSE(after_a_period.is_due(after_s(50)));
  EXPECT_TRUE(after_a_period.is_due(after_s(60)));
}

}  // namespace
}  // namespace waymark
