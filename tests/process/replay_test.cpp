// SPDX-License-Identifier: BSD-3-Clause
// Nodes on logs: order, which log a channel is read from, and errors about damaged logs.
#include "common/runtime/replay.hpp"

#include "common/errors/exit_codes.hpp"
#include "common/log/log_file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <spdlog/sinks/stdout_sinks.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <cstdio>
#include <fstream>
#include <sstream>
#include <vector>

namespace waymark {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

Message pose(std::string_view channel, std::int64_t utime_us, float x_m) {
  pose2D_t message{};
  message.utime = utime_us;
  message.x = x_m;
  return encode(Channel<pose2D_t>{channel}, message);
}

/// Records the messages that it receives.
class Listener final : public Node {
 public:
  Listener(Inbox& inbox, Outbox& outbox) : outbox_{outbox} {
    for (const std::string_view channel : {"ODOMETRY", "SLAM_POSE", "SLAM_ESTIMATE", "MAP_GRAPH"}) {
      inbox.on<pose2D_t>({channel}, [this, channel](const pose2D_t& message) {
        heard_ += std::string{channel} + " " + std::to_string(message.utime) + " " +
                  std::to_string(static_cast<int>(message.x)) + "\n";
        outbox_.publish(channels::kTruePose, message);
      });
    }
  }

  void finish() override { heard_ += "end\n"; }

  std::vector<std::string_view> needed_channels() const override { return needed_; }

  std::string heard_;
  std::vector<std::string_view> needed_{};

 private:
  Outbox& outbox_;
};

class Replay : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ = std::filesystem::path{::testing::TempDir()} /
              ::testing::UnitTest::GetInstance()->current_test_info()->name();
    std::filesystem::create_directories(folder_);
    // Earlier tests of processes leave their own logger.
    spdlog::drop("replay_test");
    spdlog::set_default_logger(spdlog::stdout_logger_mt("replay_test"));
  }

  std::filesystem::path log(const std::string& name, const std::vector<Message>& messages) const {
    LogWriter writer{folder_ / name};
    for (const Message& message : messages)
      writer.write(message);
    writer.close();
    return folder_ / name;
  }

  int replay(const std::vector<std::filesystem::path>& logs, ProcessOptions options = {}) {
    options.logs = logs;
    options.out_log = folder_ / "out.lcm";
    Inbox inbox;
    Outbox outbox;
    Listener listener{inbox, outbox};
    listener.needed_ = needed_;
    const int code = run_replay(options, listener, inbox, outbox);
    heard_ = listener.heard_;
    return code;
  }

  std::filesystem::path folder_;
  std::string heard_;
  std::vector<std::string_view> needed_{};
};

/// The percentages in the lines of progress, "replay  30 %  ...".
std::vector<int> shown_percents(const std::string& text) {
  std::vector<int> percents;
  std::istringstream lines{text};
  for (std::string line; std::getline(lines, line);) {
    int percent = 0;
    if (std::sscanf(line.c_str(), "replay %d %%", &percent) == 1) percents.push_back(percent);
  }
  return percents;
}

TEST_F(Replay, MergesLogsByTime) {
  const auto a = log("a.lcm", {pose("ODOMETRY", 1, 1), pose("ODOMETRY", 5, 1)});
  const auto b = log("b.lcm", {pose("SLAM_POSE", 3, 2)});
  EXPECT_EQ(replay({a, b}), kExitOk);
  EXPECT_EQ(heard_, "ODOMETRY 1 1\nSLAM_POSE 3 2\nODOMETRY 5 1\nend\n");
  LogReader out{folder_ / "out.lcm"};
  EXPECT_EQ(out.next()->channel, "TRUE_POSE");
}

TEST_F(Replay, ReadsOnlyTheTimesBetweenSkipAndUntil) {
  ProcessOptions options;
  options.skip_s = 2.0;
  options.until_s = 4.0;
  std::vector<Message> messages;
  for (int second = 0; second < 6; ++second)
    messages.push_back(pose("ODOMETRY", 10'000'000 + 1'000'000 * second, 1));
  EXPECT_EQ(replay({log("a.lcm", messages)}, options), kExitOk);
  EXPECT_EQ(heard_, "ODOMETRY 12000000 1\nODOMETRY 13000000 1\nODOMETRY 14000000 1\nend\n");
}

TEST_F(Replay, MessagesAfterTheClockWasSetBackAreReadAlsoIfOlderThanTheFirst) {
  ProcessOptions options;
  const auto path = log("a.lcm", {pose("ODOMETRY", 9'000'000, 1), pose("ODOMETRY", 10'000'000, 1),
                                  pose("ODOMETRY", 1'000'000, 2), pose("ODOMETRY", 2'000'000, 2)});
  EXPECT_EQ(replay({path}), kExitOk);
  EXPECT_EQ(
      heard_,
      "ODOMETRY 9000000 1\nODOMETRY 10000000 1\nODOMETRY 1000000 2\nODOMETRY 2000000 2\nend\n");
  options.skip_s = 0.5;
  EXPECT_EQ(replay({path}, options), kExitOk);
  EXPECT_EQ(heard_, "ODOMETRY 10000000 1\nODOMETRY 1000000 2\nODOMETRY 2000000 2\nend\n");
}

TEST_F(Replay, ProgressRisesOnceTo100PercentOverAllLogs) {
  std::vector<Message> early;
  std::vector<Message> late;
  for (int i = 0; i < 100; ++i) {
    early.push_back(pose("ODOMETRY", i, 1.0F));
    late.push_back(pose("SLAM_POSE", 50 + i, 2.0F));
  }
  const std::vector logs{log("early.lcm", early), log("late.lcm", late)};

  ::testing::internal::CaptureStderr();
  replay(logs);
  const std::vector<int> percents = shown_percents(::testing::internal::GetCapturedStderr());

  EXPECT_TRUE(std::ranges::is_sorted(percents)) << ::testing::PrintToString(percents);
  EXPECT_EQ(percents.back(), 100);
  EXPECT_LE(percents.size(), 11U);
}

TEST_F(Replay, ALaterLogReplacesAChannelAndAllOfSlam) {
  const auto run = log(
      "run.lcm", {pose("ODOMETRY", 1, 1), pose("SLAM_POSE", 1, 1), pose("SLAM_ESTIMATE", 2, 1)});
  const auto again = log("again.lcm", {pose("SLAM_POSE", 1, 2)});
  EXPECT_EQ(replay({run, again}), kExitOk);
  EXPECT_EQ(heard_, "ODOMETRY 1 1\nSLAM_POSE 1 2\nend\n");
}

TEST_F(Replay, APoseGraphOfAnotherSlamIsIgnored) {
  const auto run =
      log("run.lcm", {pose("ODOMETRY", 1, 1), pose("SLAM_POSE", 1, 1), pose("MAP_GRAPH", 2, 1)});
  const auto again = log("again.lcm", {pose("SLAM_ESTIMATE", 1, 2)});
  EXPECT_EQ(replay({run, again}), kExitOk);
  EXPECT_EQ(heard_.find("MAP_GRAPH"), std::string::npos);
  EXPECT_EQ(replay({run}), kExitOk);
  EXPECT_NE(heard_.find("MAP_GRAPH"), std::string::npos);
}

TEST_F(Replay, AnEmptyTimeRangeFailsAndWritesNoOutput) {
  ProcessOptions options;
  options.skip_s = 1000.0;
  const auto path = log("a.lcm", {pose("ODOMETRY", 1'000'000, 1), pose("ODOMETRY", 5'000'000, 1)});
  ::testing::internal::CaptureStdout();
  EXPECT_EQ(replay({path}, options), kExitFailed);
  EXPECT_THAT(::testing::internal::GetCapturedStdout(), HasSubstr("which is 4.0 s long"));
  EXPECT_EQ(heard_, "");
}

TEST_F(Replay, ADamagedLogIsReadToItsEndAndFails) {
  const auto path = log("damaged.lcm", {pose("ODOMETRY", 1, 1)});
  std::ofstream{path, std::ios::app} << "garbage";
  EXPECT_EQ(replay({path}), kExitFailed);
  EXPECT_EQ(heard_, "ODOMETRY 1 1\nend\n");
}

TEST_F(Replay, ALogWithoutOurChannelsFailsAndSaysWhatItHas) {
  ::testing::internal::CaptureStdout();
  EXPECT_EQ(replay({log("other.lcm", {pose("TRUE_POSE", 1, 1), pose("LASER", 2, 1)})}),
            kExitFailed);
  EXPECT_THAT(
      ::testing::internal::GetCapturedStdout(),
      HasSubstr(
          "other.lcm: has none of the channels that this process reads (MAP_GRAPH, "
          "ODOMETRY, SLAM_ESTIMATE, SLAM_POSE), but LASER, TRUE_POSE; logs of other robots are "
          "for waymark-import first"));
}

TEST_F(Replay, ALogWithoutAChannelThatIsNeededFailsAndSaysWhatItHas) {
  needed_ = {"LIDAR", "ODOMETRY"};
  ::testing::internal::CaptureStdout();
  EXPECT_EQ(replay({log("blind.lcm", {pose("ODOMETRY", 1, 1), pose("LASER", 2, 1)})}), kExitFailed);
  const std::string said = ::testing::internal::GetCapturedStdout();
  EXPECT_THAT(said, HasSubstr("blind.lcm: has no LIDAR, but LASER, ODOMETRY: did the driver run"));
  EXPECT_THAT(said, Not(HasSubstr("has no ODOMETRY")));
}

TEST_F(Replay, AnEmptyLogAmongSeveralIsAnErrorAndTheOthersAreReplayed) {
  const auto good = log("good.lcm", {pose("ODOMETRY", 1, 1)});
  ::testing::internal::CaptureStdout();
  EXPECT_EQ(replay({good, log("empty.lcm", {})}), kExitFailed);
  EXPECT_EQ(heard_, "ODOMETRY 1 1\nend\n");
  const std::string said = ::testing::internal::GetCapturedStdout();
  EXPECT_THAT(said, HasSubstr("empty.lcm: has no LCM event; is it an LCM log?"));
  EXPECT_THAT(said, Not(HasSubstr("good.lcm:")));
}

TEST_F(Replay, ALogWithoutOurChannelsBesideOneThatHasSomeIsNamedAndNoError) {
  const auto good = log("good.lcm", {pose("ODOMETRY", 1, 1)});
  const auto other = log("other.lcm", {pose("LASER", 1, 1)});
  ::testing::internal::CaptureStdout();
  EXPECT_EQ(replay({other, good}), kExitOk);
  EXPECT_EQ(heard_, "ODOMETRY 1 1\nend\n");
  EXPECT_EQ(replay({good, other}), kExitOk);
  const std::string said = ::testing::internal::GetCapturedStdout();
  EXPECT_THAT(said, HasSubstr("other.lcm: has none of the channels"));
  EXPECT_THAT(said, Not(HasSubstr("good.lcm:")));
}

TEST_F(Replay, ALogWhoseChannelsAreAllReplacedIsNoError) {
  const auto run = log("run.lcm", {pose("SLAM_POSE", 1, 1)});
  EXPECT_EQ(replay({run, log("again.lcm", {pose("SLAM_POSE", 1, 2)})}), kExitOk);
}

TEST_F(Replay, AFileThatIsNotAnLcmLogIsAnError) {
  const auto text = folder_ / "notes.txt";
  std::ofstream{text} << "no log";
  ::testing::internal::CaptureStdout();
  EXPECT_EQ(replay({text}), kExitFailed);
  const std::string said = ::testing::internal::GetCapturedStdout();
  EXPECT_THAT(said, HasSubstr("notes.txt: 6 bytes from offset 0 on are no events"));
  EXPECT_THAT(said, HasSubstr("notes.txt: has no LCM event; is it an LCM log?"));
}

TEST_F(Replay, AMissingLogIsASetupError) {
  EXPECT_THROW(replay({folder_ / "none.lcm"}), SetupError);
}

TEST_F(Replay, AnEarlierOutputLogIsKeptWhenNothingCanBeRead) {
  const auto earlier = log("out.lcm", {pose("SLAM_POSE", 1, 1)});
  EXPECT_EQ(replay({log("other.lcm", {pose("LASER", 2, 1)})}), kExitFailed);
  EXPECT_EQ(channels_in(earlier), std::vector<std::string>{"SLAM_POSE"});
  EXPECT_EQ(heard_, "");
}

TEST_F(Replay, AFolderAtTheOutputPathIsAnErrorBeforeReading) {
  const auto path = log("a.lcm", {pose("ODOMETRY", 1, 1)});
  std::filesystem::remove(folder_ / "out.lcm");
  std::filesystem::create_directory(folder_ / "out.lcm");
  EXPECT_THROW(replay({path}), SetupError);
  EXPECT_EQ(heard_, "");
}

TEST_F(Replay, RefusedMessagesFail) {
  Message bad = pose("ODOMETRY", 1, 1);
  bad.payload.push_back(0);
  EXPECT_EQ(replay({log("bad.lcm", {bad, pose("ODOMETRY", 2, 1)})}), kExitFailed);
  EXPECT_EQ(heard_, "ODOMETRY 2 1\nend\n");
}

}  // namespace
}  // namespace waymark
