// SPDX-License-Identifier: BSD-3-Clause
#include "import/findings/range_codes.hpp"

#include <gtest/gtest.h>

#include <random>
#include <vector>

namespace waymark {
namespace {

/// Returns of all distances up to 40 m.
RangeHistogram rooms() {
  RangeHistogram histogram;
  std::vector<double> ranges_m;
  for (int i = 0; i < 20'000; ++i)
    ranges_m.push_back(0.5 + 39.5 * (i % 1000) / 1000.0);
  histogram.add(ranges_m);
  return histogram;
}

TEST(RangeCodes, APileUpAtOneRangeIsNoReturn) {
  RangeHistogram histogram = rooms();
  histogram.add(std::vector<double>(200, 50.0));

  const auto code = histogram.no_return_code();

  ASSERT_TRUE(code);
  EXPECT_EQ(code->range_m, 50.0);
  EXPECT_EQ(code->count, 200);
  EXPECT_NEAR(code->share, 200.0 / 20'200.0, 1e-12);
}

TEST(RangeCodes, OfSeveralCodesTheSmallestCounts) {
  RangeHistogram histogram = rooms();
  histogram.add(std::vector<double>(900, 81.91));
  histogram.add(std::vector<double>(70, 81.87));
  histogram.add(std::vector<double>(30, 81.83));

  const auto code = histogram.no_return_code();

  ASSERT_TRUE(code);
  EXPECT_EQ(code->range_m, 81.83);
  EXPECT_EQ(code->count, 1000);
}

TEST(RangeCodes, TheFarthestReturnIsNoCode) {
  EXPECT_FALSE(rooms().no_return_code());
  EXPECT_FALSE(RangeHistogram{}.no_return_code());
}

TEST(RangeCodes, AWallBeforeAStandingRobotIsNoCode) {
  std::mt19937 random{7};
  std::normal_distribution<double> noise{0.0, 0.01};
  RangeHistogram histogram = rooms();
  std::vector<double> wall_m;
  for (int i = 0; i < 5000; ++i)
    wall_m.push_back(45.0 + noise(random));
  histogram.add(wall_m);

  EXPECT_FALSE(histogram.no_return_code());
}

}  // namespace
}  // namespace waymark
