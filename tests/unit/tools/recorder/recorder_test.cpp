// SPDX-License-Identifier: BSD-3-Clause
#include "recorder/recorder_node.hpp"
#include "unit/tools/temporary_folder.hpp"

#include <gtest/gtest.h>

namespace waymark {
namespace {

using evaluate::TemporaryFolder;

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
