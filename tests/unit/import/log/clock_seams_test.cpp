// SPDX-License-Identifier: BSD-3-Clause
#include "import/log/clock_seams.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

namespace waymark {
namespace {

using ::testing::IsEmpty;
using ::testing::SizeIs;

constexpr std::int64_t kPeriod_us = 200'000;
constexpr std::int64_t kSecond_us = 1'000'000;

/// `count` stamps, five per second.
std::vector<Timestamp> from(std::int64_t start_us, int count) {
  std::vector<Timestamp> stamps;
  for (int i = 0; i < count; ++i)
    stamps.push_back(timestamp_from_us(start_us + i * kPeriod_us));
  return stamps;
}

std::vector<Timestamp> joined(std::vector<Timestamp> first, const std::vector<Timestamp>& second) {
  first.insert(first.end(), second.begin(), second.end());
  return first;
}

std::vector<Timestamp> corrected(const std::vector<Timestamp>& stamps) {
  const auto late = corrections(stamps, find_clock_seams(stamps));
  std::vector<Timestamp> times;
  for (std::size_t i = 0; i < stamps.size(); ++i)
    times.push_back(stamps[i] + late[i]);
  return times;
}

TEST(ClockSeams, AfterAClockSetBackStampsContinueAtTheUsualPeriod) {
  const auto stamps = joined(from(5'000 * kSecond_us, 60), from(1'400 * kSecond_us, 40));

  const auto seams = find_clock_seams(stamps);

  ASSERT_THAT(seams, SizeIs(1));
  EXPECT_EQ(seams[0].index, 60U);
  EXPECT_EQ(corrected(stamps), from(5'000 * kSecond_us, 100));
}

TEST(ClockSeams, TheLongestPieceKeepsItsStampsUnlessSomeWouldBeBefore0) {
  const auto set_ahead = joined(from(0, 20), from(1'000'000'000 * kSecond_us, 80));
  EXPECT_EQ(corrected(set_ahead), from(1'000'000'000 * kSecond_us - 20 * kPeriod_us, 100));
  const auto set_back = joined(from(1'000 * kSecond_us, 20), from(0, 80));
  EXPECT_EQ(corrected(set_back), from(1'000 * kSecond_us, 100));
}

TEST(ClockSeams, SingleWrongStampsAndUnorderedStampsAreNoSeams) {
  auto stamps = from(100 * kSecond_us, 60);
  stamps[30] += std::chrono::hours{1};
  stamps[40] -= std::chrono::seconds{50};
  EXPECT_THAT(find_clock_seams(stamps), IsEmpty());
  std::ranges::reverse(stamps);
  EXPECT_THAT(find_clock_seams(stamps), IsEmpty());
  EXPECT_THAT(find_clock_seams({}), IsEmpty());
}

TEST(ClockSeams, PiecesOfOneRecordingInTheWrongOrderAreFound) {
  const auto swapped = joined(from(30 * kSecond_us, 100), from(10 * kSecond_us, 100));
  EXPECT_TRUE(are_pieces_in_disorder(swapped, find_clock_seams(swapped)));
  const auto overlapping = joined(from(30 * kSecond_us, 100), from(11 * kSecond_us, 100));
  EXPECT_FALSE(are_pieces_in_disorder(overlapping, find_clock_seams(overlapping)));
  const auto set_back = joined(from(3'000 * kSecond_us, 100), from(10 * kSecond_us, 100));
  EXPECT_FALSE(are_pieces_in_disorder(set_back, find_clock_seams(set_back)));
}

}  // namespace
}  // namespace waymark
