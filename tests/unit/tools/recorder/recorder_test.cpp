// SPDX-License-Identifier: BSD-3-Clause
#include "common/logging/logging.hpp"
#include "recorder/recorder_node.hpp"
#include "unit/tools/temporary_folder.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>

namespace waymark {
namespace {

using evaluate::TemporaryFolder;
using ::testing::HasSubstr;

class Recorder : public ::testing::Test {
 protected:
  void record(const std::filesystem::path& log) {
    RecorderNode node{{.recorder = {}, .out_log = log}, inbox_, outbox_};
    node.finish();
  }

  const TemporaryFolder folder_;
  Inbox inbox_;
  Outbox outbox_;
};

TEST_F(Recorder, WritesALogEvenWithoutMessages) {
  record(folder_.path() / "run.lcm");
  EXPECT_TRUE(std::filesystem::exists(folder_.path() / "run.lcm"));
}

TEST_F(Recorder, CountsWhatItHasWrittenByChannel) {
  RecorderNode node{
      {.recorder = {{"CAMERA"}}, .out_log = folder_.path() / "run.lcm"}, inbox_, outbox_};
  for (const char* channel : {"LIDAR", "LIDAR", "CAMERA"})
    inbox_.deliver({channel, Timestamp{}, {}});
  EXPECT_EQ(inbox_.counters().get("LIDAR recorded"), 2);
  EXPECT_EQ(inbox_.counters().get("CAMERA recorded"), 0);
}

TEST_F(Recorder, ACommandBeforeTheSensorsGetsTheTimeOfTheirFirstMessage) {
  const auto log = folder_.path() / "run.lcm";
  RecorderNode node{{.recorder = {}, .out_log = log}, inbox_, outbox_};
  inbox_.deliver({"SLAM_COMMAND", Timestamp{}, {1}});
  inbox_.deliver({"SLAM_REPLY", Timestamp{}, {2}});
  inbox_.deliver({"LIDAR", timestamp_from_us(1'234'000'000), {3}});
  node.finish();
  LogReader reader{log};
  for (const char* channel : {"SLAM_COMMAND", "SLAM_REPLY", "LIDAR"}) {
    const auto message = reader.next();
    ASSERT_TRUE(message);
    EXPECT_EQ(message->channel, channel);
    EXPECT_EQ(message->time, timestamp_from_us(1'234'000'000));
  }
}

TEST_F(Recorder, ACommandAloneIsRecorded) {
  const auto log = folder_.path() / "run.lcm";
  RecorderNode node{{.recorder = {}, .out_log = log}, inbox_, outbox_};
  inbox_.deliver({"SLAM_COMMAND", Timestamp{}, {1}});
  node.finish();
  EXPECT_EQ(channels_in(log), std::vector<std::string>{"SLAM_COMMAND"});
}

TEST_F(Recorder, SaysEvery10SecondsWhatHasComeAndWhatNoLongerComes) {
  RecorderNode node{{.recorder = {}, .out_log = folder_.path() / "run.lcm"}, inbox_, outbox_};
  logging::begin("recorder_test");
  const auto start = std::chrono::steady_clock::now();
  const auto said_after = [&](int seconds) {
    ::testing::internal::CaptureStderr();
    node.poll({.now = start + std::chrono::seconds{seconds}});
    return ::testing::internal::GetCapturedStderr();
  };
  EXPECT_EQ(said_after(0), "");
  for (const char* channel : {"LIDAR", "CAMERA", "LIDAR"})
    inbox_.deliver({channel, timestamp_from_us(1), {}});
  EXPECT_EQ(said_after(9), "");
  EXPECT_THAT(said_after(10), HasSubstr("recorded in 10 s: CAMERA 1, LIDAR 2\n"));
  inbox_.deliver({"CAMERA", timestamp_from_us(2), {}});
  EXPECT_THAT(said_after(20), HasSubstr("recorded in 10 s: CAMERA 1, LIDAR 0\n"));
}

TEST_F(Recorder, AnEarlierLogIsNotReplaced) {
  const auto log = folder_.file("run.lcm", "an hour of driving");
  EXPECT_THROW(record(log), SetupError);
  EXPECT_EQ(std::filesystem::file_size(log), 18U);
}

TEST_F(Recorder, AFileOfACrashedRecordingIsNotReplaced) {
  const auto part = folder_.file("run.lcm.part", "an hour of driving");
  EXPECT_THROW(record(folder_.path() / "run.lcm"), SetupError);
  EXPECT_EQ(std::filesystem::file_size(part), 18U);
  EXPECT_FALSE(std::filesystem::exists(folder_.path() / "run.lcm"));
}

TEST_F(Recorder, AFailedStartDoesNotBlockTheNext) {
  {
    const RecorderNode never_joined{
        {.recorder = {}, .out_log = folder_.path() / "run.lcm"}, inbox_, outbox_};
  }
  EXPECT_NO_THROW(record(folder_.path() / "run.lcm"));
}

}  // namespace
}  // namespace waymark
