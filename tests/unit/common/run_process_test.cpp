// SPDX-License-Identifier: BSD-3-Clause
// Command lines with impossible demands are refused before anything is done.
#include "common/runtime/run_process.hpp"

#include "common/errors/exit_codes.hpp"
#include "common/log/log_file.hpp"
#include "common/messages/channels.hpp"
#include "common/runtime/progress.hpp"
#include "common/runtime/run_simulator.hpp"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <chrono>
#include <cstdio>
#include <filesystem>
#include <fstream>

namespace waymark {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

struct Refused {
  int exit_code{0};
  std::string output{};
};

/// Runs a process whose node must not be made. Each needs a unique name, which its logger has, too.
Refused run(std::string_view name, std::vector<std::string> words) {
  words.insert(words.begin(), "program");
  std::vector<char*> arguments;
  for (std::string& word : words)
    arguments.push_back(word.data());
  ::testing::internal::CaptureStderr();
  const int exit_code = run_described_process(
      static_cast<int>(arguments.size()), arguments.data(),
      {.traits = {name, "Does nothing.", false},
       .option_set = {.large_messages = true, .log = true, .out_log = true},
       .make_node = [](const ProcessOptions&, Inbox&, Outbox&) -> std::unique_ptr<Node> {
         throw std::logic_error{"a node was made"};
       }});
  return {exit_code, ::testing::internal::GetCapturedStderr()};
}

TEST(RunProcess, OptionsOfLiveRunsAreRefusedWithALog) {
  const Refused real_time = run("fast", {"--log", "run.lcm", "--real-time"});
  EXPECT_EQ(real_time.exit_code, kExitUsage);
  EXPECT_THAT(real_time.output, HasSubstr("leave out --real-time"));

  const Refused network = run("networked", {"--log", "run.lcm", "--lcm-url", "nonsense"});
  EXPECT_EQ(network.exit_code, kExitUsage);
  EXPECT_THAT(network.output, HasSubstr("leave out --real-time and --lcm-url"));
}

TEST(RunProcess, LargeMessagesNeedRealTime) {
  const Refused refused = run("unused", {"--large-messages"});
  EXPECT_EQ(refused.exit_code, kExitUsage);
  EXPECT_THAT(refused.output, HasSubstr("--large-messages needs --real-time"));
}

TEST(RunProcess, ATimeToListenNeedsRealTime) {
  ::testing::internal::CaptureStderr();
  std::vector<std::string> words{"program", "--for-s", "5"};
  std::vector<char*> arguments{words[0].data(), words[1].data(), words[2].data()};
  const int exit_code = run_described_process(
      3, arguments.data(),
      {.traits = {"timed", "Does nothing.", false}, .option_set = {.for_s = true}});
  EXPECT_THAT(::testing::internal::GetCapturedStderr(), HasSubstr("--for-s needs --real-time"));
  EXPECT_EQ(exit_code, kExitUsage);
}

/// Counts the polls.
class PolledNode final : public Node {
 public:
  explicit PolledNode(int& polls, Inbox& inbox) : polls_{polls} {
    inbox.on<pose2D_t>(channels::kOdometry, [](const pose2D_t&) {});
  }

  void poll(const WallClock& clock) override {
    EXPECT_FALSE(clock.silence_s("ODOMETRY")) << "nothing has come";
    ++polls_;
  }

  void finish() override {}

 private:
  int& polls_;
};

TEST(RunProcess, InRealTimeItEndsAfterTheGivenTimeAndTheNodeIsPolledMeanwhile) {
  int polls = 0;
  std::vector<std::string> words{"program", "--real-time", "--for-s",
                                 "1.2",     "--lcm-url",   "memq://"};
  std::vector<char*> arguments;
  for (std::string& word : words)
    arguments.push_back(word.data());
  ::testing::internal::CaptureStderr();
  const auto start = std::chrono::steady_clock::now();
  const int exit_code =
      run_described_process(static_cast<int>(arguments.size()), arguments.data(),
                            {.traits = {"listening", "Listens.", false},
                             .option_set = {.for_s = true},
                             .make_node = [&](const ProcessOptions&, Inbox& inbox, Outbox&) {
                               return std::make_unique<PolledNode>(polls, inbox);
                             }});
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - start;
  EXPECT_THAT(::testing::internal::GetCapturedStderr(), HasSubstr("nothing came on memq://"));
  EXPECT_EQ(exit_code, kExitFailed);
  EXPECT_GE(took.count(), 1.2);
  EXPECT_GE(polls, 2);
}

TEST(RunProcess, AFileThatANodeCannotExamineIsASetupError) {
  ::testing::internal::CaptureStderr();
  std::string program{"program"};
  char* arguments[] = {program.data()};
  const int exit_code = run_described_process(
      1, arguments,
      {.traits = {"unable", "Does nothing.", false},
       .make_node = [](const ProcessOptions&, Inbox&, Outbox&) -> std::unique_ptr<Node> {
         throw fs::filesystem_error{"status", "no/map",
                                    std::make_error_code(std::errc::permission_denied)};
       }});
  EXPECT_THAT(::testing::internal::GetCapturedStderr(), HasSubstr("no/map: Permission denied"));
  EXPECT_EQ(exit_code, kExitUsage);
}

TEST(RunProcess, AnOutputLogNeedsAnInputLog) {
  const Refused live = run("live", {"--out-log", "out.lcm"});
  EXPECT_EQ(live.exit_code, kExitUsage);
  EXPECT_THAT(live.output, HasSubstr("--out-log needs --log"));
}

/// Fails on its second message.
class FailingNode final : public Node {
 public:
  FailingNode(Inbox& inbox, Outbox& outbox) : outbox_{outbox} {
    inbox.on<pose2D_t>(channels::kOdometry, [this](const pose2D_t& pose) {
      if (++heard_ == 2) throw std::length_error{"the second is too much"};
      outbox_.publish(channels::kSlamPose, pose);
    });
  }

  void finish() override { outbox_.publish(channels::kTruePose, pose2D_t{}); }

 private:
  Outbox& outbox_;
  int heard_{0};
};

TEST(RunProcess, ANodeThatThrowsFinishesWithWhatItHas) {
  const fs::path folder = fs::path{::testing::TempDir()} / "failing_node";
  fs::create_directories(folder);
  const std::string in = (folder / "in.lcm").string();
  const std::string out = (folder / "out.lcm").string();
  {
    LogWriter log{in};
    for (std::int64_t i = 1; i <= 3; ++i) {
      pose2D_t pose{};
      pose.utime = i;
      log.write(encode(channels::kOdometry, pose));
    }
    log.close();
  }
  std::vector<std::string> words{"program", "--log", in, "--out-log", out};
  std::vector<char*> arguments;
  for (std::string& word : words)
    arguments.push_back(word.data());
  ::testing::internal::CaptureStderr();
  const int exit_code =
      run_described_process(static_cast<int>(arguments.size()), arguments.data(),
                            {.traits = {"failing", "Fails.", false},
                             .option_set = {.log = true, .out_log = true},
                             .make_node = [](const ProcessOptions&, Inbox& inbox, Outbox& outbox) {
                               return std::make_unique<FailingNode>(inbox, outbox);
                             }});
  EXPECT_THAT(::testing::internal::GetCapturedStderr(), HasSubstr("the second is too much"));
  EXPECT_EQ(exit_code, kExitFailed);
  EXPECT_EQ(channels_in(out), (std::vector<std::string>{"SLAM_POSE", "TRUE_POSE"}));
  fs::remove_all(folder);
}

class ProtectedInputs : public ::testing::Test {
 protected:
  ProtectedInputs() {
    fs::remove_all(folder_);
    fs::create_directories(folder_ / "deeper");
    for (const char* name : {"run.lcm", "slam.toml"})
      std::ofstream{folder_ / name} << "precious";
    fs::create_symlink(folder_ / "run.lcm", folder_ / "link.lcm");
    fs::create_symlink(folder_ / "slam.toml", folder_ / "link.toml");
  }

  ~ProtectedInputs() override { fs::remove_all(folder_); }

  std::string path(const std::string& name) const { return (folder_ / name).string(); }

  /// Expects that writing to `out` is refused because it is `input`, and that `input` is unchanged.
  void expect_refused(const std::string& process, const std::string& out,
                      const std::string& input) const {
    const Refused refused = run(
        process, {"--log", path("run.lcm"), "--config", path("slam.toml"), "--out-log", path(out)});
    EXPECT_EQ(refused.exit_code, kExitUsage) << out;
    EXPECT_THAT(refused.output, HasSubstr("would overwrite " + path(input))) << out;
    std::string content;
    std::ifstream{folder_ / input} >> content;
    EXPECT_EQ(content, "precious") << out;
  }

  const fs::path folder_ = fs::path{::testing::TempDir()} /
                           ::testing::UnitTest::GetInstance()->current_test_info()->name();
};

TEST_F(ProtectedInputs, ALogIsNotOverwrittenByAnyName) {
  expect_refused("log", "run.lcm", "run.lcm");
  expect_refused("log_spelt", "deeper/../run.lcm", "run.lcm");
  expect_refused("log_linked", "link.lcm", "run.lcm");
}

TEST_F(ProtectedInputs, AConfigurationFileIsNotOverwritten) {
  expect_refused("file", "slam.toml", "slam.toml");
  expect_refused("file_spelt", "./deeper/../slam.toml", "slam.toml");
  expect_refused("file_linked", "link.toml", "slam.toml");
}

TEST_F(ProtectedInputs, LinksToAnInputAreTheSameFile) {
  const Refused refused = run("links", {"--log", path("link.lcm"), "--out-log", path("run.lcm")});
  EXPECT_EQ(refused.exit_code, kExitUsage);
  EXPECT_THAT(refused.output, HasSubstr("would overwrite " + path("link.lcm")));
}

/// Records the calls.
class Source final : public TickSource {
 public:
  explicit Source(std::string& asked) : asked_{asked} {}

  std::vector<std::string> participants() const override { return {}; }

  int window_ticks() const override { return 1; }

  std::int64_t run_id() const override { return 1; }

  void begin() override { asked_ += "begin "; }

  bool finished() const override { return finished_; }

  std::vector<Message> advance(Timestamp&) override {
    asked_ += "advance ";
    finished_ = true;
    return {};
  }

  double progress_fraction() const override { return 1.0; }

  std::string progress_text() const override { return ""; }

  void finish() override { asked_ += "finish "; }

 private:
  std::string& asked_;
  bool finished_{false};
};

struct Simulated {
  Refused result{};
  std::string asked{};
};

/// Makes a stream of this process fail at writing, as on a full disk.
class FullStream {
 public:
  explicit FullStream(std::FILE* stream)
      : stream_{stream}, descriptor_{fileno(stream)}, saved_{::dup(descriptor_)} {
    std::fflush(stream_);
    const int full = ::open("/dev/full", O_WRONLY | O_CLOEXEC);
    ::dup2(full, descriptor_);
    ::close(full);
  }

  FullStream(const FullStream&) = delete;
  FullStream& operator=(const FullStream&) = delete;

  ~FullStream() {
    std::fflush(stream_);
    std::clearerr(stream_);
    ::dup2(saved_, descriptor_);
    ::close(saved_);
  }

 private:
  std::FILE* stream_;
  int descriptor_;
  int saved_;
};

Simulated simulate(std::string_view name, std::vector<std::string> words) {
  words.insert(words.begin(), "program");
  std::vector<char*> arguments;
  for (std::string& word : words)
    arguments.push_back(word.data());
  Simulated simulated;
  ::testing::internal::CaptureStderr();
  simulated.result.exit_code = run_described_simulator(
      static_cast<int>(arguments.size()), arguments.data(),
      {.traits = {name, "Does nothing.", false},
       .config = {.value =
                      [](const ProcessOptions&, const std::string&) {
                        return "7";
                      }},
       .make_source = [&](const ProcessOptions&,
                          Inbox&) { return std::make_unique<Source>(simulated.asked); },
       .files = {"scenario.toml"}});
  simulated.result.output = ::testing::internal::GetCapturedStderr();
  return simulated;
}

TEST(RunSimulator, WithANetworkItBeginsAdvancesAndFinishes) {
  const Simulated simulated = simulate("joined", {"--lcm-url", "memq://"});
  EXPECT_EQ(simulated.result.exit_code, kExitOk) << simulated.result.output;
  EXPECT_EQ(simulated.asked, "begin advance finish ");
}

TEST(RunSimulator, WithoutANetworkItDoesNotBegin) {
  const Simulated simulated = simulate("alone", {"--lcm-url", "no-such-scheme://"});
  EXPECT_EQ(simulated.result.exit_code, kExitUsage);
  EXPECT_EQ(simulated.asked, "");
}

TEST(RunSimulator, OutputThatIsLostIsAFailure) {
  Simulated simulated;
  {
    const FullStream full{stdout};
    simulated = simulate("lossy", {"--print-config", "run.seed"});
  }
  EXPECT_EQ(simulated.result.exit_code, kExitFailed);
  EXPECT_THAT(simulated.result.output, HasSubstr("standard output"));
}

TEST(RunSimulator, LargeMessagesAreNotOffered) {
  EXPECT_EQ(simulate("large", {"--large-messages", "--lcm-url", "memq://"}).result.exit_code,
            kExitUsage);
}

TEST(ProgressOfWork, GoesOnWhereItCannotBeShown) {
  const FullStream full{stderr};
  Progress progress{"work"};
  EXPECT_NO_THROW(progress.show(0.5, "half"));
  EXPECT_NO_THROW(progress.done());
}

TEST_F(ProtectedInputs, AScenarioIsNotOverwrittenByTheCopyInTheOutputFolder) {
  std::ofstream{folder_ / "scenario.toml"} << "precious";
  const Simulated simulated =
      simulate("over", {"--lcm-url", "memq://", "--config", path("deeper/../scenario.toml"),
                        "--out", folder_.string()});
  EXPECT_EQ(simulated.result.exit_code, kExitUsage);
  EXPECT_THAT(simulated.result.output, HasSubstr("--out: " + path("scenario.toml") + " would"));
  EXPECT_EQ(simulated.asked, "");
}

}  // namespace
}  // namespace waymark
