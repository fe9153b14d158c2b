// SPDX-License-Identifier: BSD-3-Clause
// Which missing and silent channels are named, and when.
#include "common/runtime/silence_monitor.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

namespace waymark {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

/// A process on a network, checked every 0.25 s.
class SilentNetwork : public ::testing::Test {
 protected:
  /// Channels that come every 0.25 s until that time.
  void run(double until_s, const std::vector<std::string_view>& coming, double step_s = 0.25) {
    for (; now_s_ < until_s; now_s_ += step_s) {
      const auto now = start_ + std::chrono::milliseconds{std::lround(1000.0 * now_s_)};
      for (const std::string_view name : coming)
        note_heard(heard_, name, now);
      for (const SilenceMonitor::Line& line : monitor_.check(heard_, now))
        said_.push_back(line.text);
    }
  }

  std::vector<std::string> take_said() { return std::exchange(said_, {}); }

  SilenceMonitor::Time start_{};
  double now_s_{0.0};
  HeardChannels heard_{};
  SilenceMonitor monitor_{{"LIDAR", "ODOMETRY"}, {{"LIDAR"}, {"ODOMETRY"}}, {}, "udpm://x", start_};
  std::vector<std::string> said_{};
};

TEST_F(SilentNetwork, EachMissingChannelIsNamedOnceWithTheUnknownOnesThatCome) {
  run(9.9, {"SCAN", "ODOMETRY", "CAMERA", "SLAM_STATUS"});
  EXPECT_THAT(take_said(), IsEmpty());
  run(30.0, {"SCAN", "ODOMETRY", "CAMERA", "SLAM_STATUS"});
  EXPECT_THAT(take_said(),
              ElementsAre("no LIDAR so far; heard on this network: SCAN (see [channels])"));
}

TEST_F(SilentNetwork, WithoutUnknownChannelsTheDriverIsSuspected) {
  run(30.0, {"ODOMETRY"});
  EXPECT_THAT(take_said(), ElementsAre("no LIDAR so far; does its driver run?"));
}

TEST_F(SilentNetwork, OnlyWhereNothingComesTheNetworkIsSuspected) {
  run(30.0, {"SLAM_STATUS"});
  EXPECT_THAT(take_said(),
              ElementsAre("nothing has come on udpm://x so far; is it the robot's LCM network?"));
}

TEST_F(SilentNetwork, AChannelThatFallsSilentIsNamedOnceAndWhenItIsBack) {
  run(20.0, {"LIDAR", "ODOMETRY"});
  run(27.0, {"LIDAR"});
  EXPECT_THAT(take_said(), ElementsAre(HasSubstr("ODOMETRY has been silent for 2.0 s")));
  run(30.0, {"LIDAR", "ODOMETRY"});
  EXPECT_THAT(take_said(), ElementsAre("ODOMETRY is back after 7.2 s"));
}

TEST_F(SilentNetwork, ASlowChannelIsNotSilentBetweenItsMessages) {
  for (int i = 0; i < 10; ++i) {
    run(3.0 * i + 0.2, {"LIDAR", "ODOMETRY"});
    run(3.0 * i + 3.0, {"ODOMETRY"});
  }
  said_.clear();  // the first period is not known
  run(30.2, {"LIDAR", "ODOMETRY"});
  run(35.0, {"ODOMETRY"});
  EXPECT_THAT(take_said(), IsEmpty());
  run(45.0, {"ODOMETRY"});
  EXPECT_THAT(take_said(), ElementsAre(HasSubstr("LIDAR has been silent for")));
}

TEST_F(SilentNetwork, AProcessThatWasStoppedItselfBlamesNobody) {
  run(20.0, {"LIDAR", "ODOMETRY"});
  now_s_ = 60.0;  // what came meanwhile is not received yet
  run(60.2, {});
  run(65.0, {"LIDAR", "ODOMETRY"});
  EXPECT_THAT(take_said(), IsEmpty());
}

TEST(SilenceMonitor, AProcessThatNeedsNoChannelIsToldOfOthersOnly) {
  SilenceMonitor monitor{{}, {{"CAMERA"}}, {}, "udpm://x", {}};
  HeardChannels heard;
  SilenceMonitor::Time now{};
  note_heard(heard, "CAM0", now);
  std::vector<SilenceMonitor::Line> lines;
  for (int i = 0; lines.empty() && i < 100; ++i)
    lines = monitor.check(heard, now += std::chrono::milliseconds{250});
  ASSERT_EQ(lines.size(), 1U);
  EXPECT_THAT(lines[0].text, HasSubstr("none of the channels of this process so far"));
  EXPECT_THAT(lines[0].text, HasSubstr("CAM0 (see [channels])"));
}

TEST(HeardChannelsTest, InventedNamesDoNotFillTheMemory) {
  HeardChannels heard;
  for (int i = 0; i < 10'000; ++i)
    note_heard(heard, "NAME" + std::to_string(i), {});
  EXPECT_LE(heard.size(), 200U);
  note_heard(heard, "NAME0", {});
  EXPECT_EQ(heard.at("NAME0").count, 2);
}

}  // namespace
}  // namespace waymark
