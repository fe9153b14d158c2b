// SPDX-License-Identifier: BSD-3-Clause
#include "import/mbot/clocks.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace waymark {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

constexpr std::int64_t kSecond_us = 1'000'000;

/// Sixty messages, stamped every second from `first_us` on by their own clock, and logged a little
/// later by another clock, which is ahead.
ChannelClock channel(std::int64_t first_us, std::int64_t logger_ahead_us) {
  ChannelClock clock;
  for (int i = 0; i < 60; ++i) {
    const std::int64_t stamp_us = first_us + i * kSecond_us;
    const std::int64_t delay_us = i % 10 == 0 ? 500'000 : 5'000;  // bursts
    clock.add(timestamp_from_us(stamp_us),
              timestamp_from_us(stamp_us + logger_ahead_us + delay_us));
  }
  return clock;
}

struct Result {
  Timestamp time;
  std::vector<std::string> notes;
};

Result put(const ChannelClock& lidar, const ChannelClock& odometry, std::int64_t time_us) {
  std::vector<ImportedPose> poses{{timestamp_from_us(time_us), 0, {}}};
  ImportReport report{"log", AddressUnit::kByte};
  put_on_clock(lidar, odometry, "odometry", poses, report);
  return {poses[0].time, report.notes()};
}

TEST(Clocks, StampsOfAnotherClockAreShiftedByTheLogTimes) {
  // Odometry's clock started with its microcontroller; the LiDAR's clock is that of the host.
  const auto [time, notes] = put(channel(5'000 * kSecond_us, 0),
                                 channel(3 * kSecond_us, 4'997 * kSecond_us), 10 * kSecond_us);

  EXPECT_EQ(time, timestamp_from_us(5'007 * kSecond_us));
  EXPECT_THAT(notes, ElementsAre(HasSubstr("4997.000 s apart by the logger's times")));
}

TEST(Clocks, StampsOfOneClockAreUnchanged) {
  const ChannelClock lidar = channel(5'000 * kSecond_us, 0);
  const auto [time, notes] = put(lidar, channel(5'000 * kSecond_us, 400'000), 10 * kSecond_us);
  EXPECT_EQ(time, timestamp_from_us(10 * kSecond_us)) << "a late driver is no other clock";
  EXPECT_THAT(notes, IsEmpty());
}

TEST(Clocks, ConstantLogTimesOrAMissingChannelGiveNoNote) {
  ChannelClock lidar;
  ChannelClock odometry;
  for (int i = 0; i < 60; ++i) {
    lidar.add(timestamp_from_us(i * kSecond_us), timestamp_from_us(5));
    odometry.add(timestamp_from_us((900 + i) * kSecond_us), timestamp_from_us(5));
  }
  EXPECT_THAT(put(lidar, odometry, kSecond_us).notes, IsEmpty());
  EXPECT_THAT(put({}, odometry, kSecond_us).notes, IsEmpty());
}

}  // namespace
}  // namespace waymark
