// SPDX-License-Identifier: BSD-3-Clause
#include "common/bus/channel_owners.hpp"

#include <gtest/gtest.h>

namespace waymark {
namespace {

using std::chrono::milliseconds;
using Verdict = ChannelOwners::Verdict;

constexpr Sender kDriver{0x7f000001, 40000};
constexpr Sender kOther{0x7f000001, 40001};
constexpr Sender kThird{0x7f000001, 40002};

constexpr ChannelOwners::Time at(int time_ms) {
  return ChannelOwners::Time{} + milliseconds{time_ms};
}

TEST(ChannelOwners, ASecondPublisherIsRefusedWhileTheFirstIsActive) {
  ChannelOwners owners;
  EXPECT_EQ(owners.check("LIDAR", kDriver, at(0)), Verdict::kAccepted);
  EXPECT_EQ(owners.check("LIDAR", kOther, at(1)), Verdict::kRefused);
  EXPECT_EQ(owners.check("LIDAR", kDriver, at(1900)), Verdict::kAccepted);
  EXPECT_EQ(owners.check("LIDAR", kOther, at(3900)), Verdict::kRefused);
  EXPECT_EQ(owners.owner_of("LIDAR"), kDriver);
}

TEST(ChannelOwners, ARestartedDriverBecomesTheOwner) {
  ChannelOwners owners;
  owners.check("LIDAR", kDriver, at(0));
  EXPECT_EQ(owners.check("LIDAR", kOther, at(2000)), Verdict::kRefused);
  EXPECT_EQ(owners.check("LIDAR", kOther, at(2001)), Verdict::kNewOwner);
  EXPECT_EQ(owners.check("LIDAR", kOther, at(2002)), Verdict::kAccepted);
}

TEST(ChannelOwners, AnyMessageOfTheOwnerKeepsItActive) {
  ChannelOwners owners;
  owners.check("MARKERS", kDriver, at(0));
  for (int time_ms = 1000; time_ms <= 60000; time_ms += 1000)
    owners.note_activity(kDriver, at(time_ms));
  EXPECT_EQ(owners.check("MARKERS", kOther, at(61000)), Verdict::kRefused);
}

TEST(ChannelOwners, ChannelsOfSeveralDriversAreNoConflict) {
  ChannelOwners owners;
  for (int time_ms = 0; time_ms < 5000; time_ms += 100) {
    EXPECT_EQ(owners.check("LIDAR", kDriver, at(time_ms)), Verdict::kAccepted);
    EXPECT_EQ(owners.check("ODOMETRY", kOther, at(time_ms)), Verdict::kAccepted);
  }
}

// Both senders begin at the same time, each first on another channel.
TEST(ChannelOwners, TwoDrivesOnTheSameChannelsAreNotMixed) {
  ChannelOwners owners;
  EXPECT_EQ(owners.check("ODOMETRY", kDriver, at(0)), Verdict::kAccepted);
  EXPECT_EQ(owners.check("LIDAR", kOther, at(1)), Verdict::kAccepted);
  EXPECT_EQ(owners.check("ODOMETRY", kOther, at(2)), Verdict::kRefused);
  EXPECT_EQ(owners.check("LIDAR", kDriver, at(3)), Verdict::kNewOwner);
  for (int time_ms = 10; time_ms < 5000; time_ms += 10) {
    for (const char* channel : {"LIDAR", "ODOMETRY", "CAMERA"}) {
      EXPECT_EQ(owners.check(channel, kDriver, at(time_ms)), Verdict::kAccepted);
      EXPECT_EQ(owners.check(channel, kOther, at(time_ms)), Verdict::kRefused);
    }
  }
}

// A log with MARKERS is played while a detector runs: its other channels are still accepted.
TEST(ChannelOwners, ARefusedSenderIsAcceptedOnOtherChannels) {
  ChannelOwners owners;
  owners.check("MARKERS", kDriver, at(0));
  EXPECT_EQ(owners.check("MARKERS", kOther, at(1)), Verdict::kRefused);
  EXPECT_EQ(owners.check("LIDAR", kOther, at(2)), Verdict::kAccepted);
}

TEST(ChannelOwners, ManyForgedSendersAreRefusedInBoundedMemory) {
  ChannelOwners owners;
  owners.check("LIDAR", kDriver, at(0));
  for (int i = 0; i < 100000; ++i) {
    owners.note_activity(kDriver, at(i));
    const Sender forged{0x0a000000U + static_cast<std::uint32_t>(i), 1};
    ASSERT_EQ(owners.check("LIDAR", forged, at(i)), Verdict::kRefused);
  }
  EXPECT_EQ(owners.check("LIDAR", kThird, at(100000)), Verdict::kRefused);
  EXPECT_EQ(owners.check("LIDAR", kDriver, at(100000)), Verdict::kAccepted);
}

}  // namespace
}  // namespace waymark
