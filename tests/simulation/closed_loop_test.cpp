// SPDX-License-Identifier: BSD-3-Clause
// The whole stack with its real programs on a short corridor: results are right, the same every
// time, and survive killed and paused processes.
#include "common/log/log_file.hpp"
#include "common/messages/channels.hpp"
#include "common/messages/codec.hpp"
#include "support/lcm_network.hpp"
#include "support/programs.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <csignal>
#include <fstream>
#include <future>
#include <map>
#include <sstream>
#include <thread>

namespace waymark {
namespace {

using namespace std::chrono_literals;
using namespace testing_support;
using ::testing::HasSubstr;

namespace fs = std::filesystem;

const fs::path kSource{WAYMARK_SOURCE_DIR};
const fs::path kPrograms{WAYMARK_BUILD_DIR};
constexpr const char* kRow = "waymark";

class ClosedLoop : public ::testing::Test {
 protected:
  /// One undisturbed run that all tests compare with.
  static void SetUpTestSuite() {
    fs::remove_all(folder());
    fs::create_directories(folder());
    reference_ = launch("reference");
  }

  static void TearDownTestSuite() { fs::remove_all(folder()); }

  void SetUp() override { ASSERT_EQ(reference_.exit_code, 0) << reference_.output; }

  static fs::path folder() {
    return fs::temp_directory_path() / ("waymark-closed-loop-" + std::to_string(getpid()));
  }

  static Finished launch(const std::string& name, const std::string& options = "") {
    return run_command((kSource / "deploy/launch.sh").string() + " " +
                       (kSource / "tests/data/scenarios/short.toml").string() + " --estimator " +
                       kRow + " --out " + (folder() / name).string() + " " + options);
  }

  static std::future<Finished> launch_in_background(const std::string& name,
                                                    const std::string& options = "") {
    return std::async(std::launch::async, [=] { return launch(name, options); });
  }

  /// Waits until the run is well under way, then returns one of its processes.
  static pid_t process_of_run(const std::string& name, const std::string& program) {
    EXPECT_TRUE(wait_for_size(folder() / name / "run.lcm.part", 300'000, 30s));
    const auto pid = wait_for_process({"waymark-" + program, (folder() / name).string()}, 10s);
    EXPECT_TRUE(pid) << program;
    return pid.value_or(0);
  }

  static void expect_same_result(const std::string& name) {
    for (const std::string file :
         {"run.lcm", "truth.tum", "waymark/map.pgm", "waymark/map.yaml", "waymark/trajectory.tum",
          "waymark/markers.csv", "waymark/graph.g2o"}) {
      EXPECT_TRUE(content_of(folder() / name / file) == content_of(folder() / "reference" / file))
          << file << " of " << name << " differs from that of the undisturbed run";
    }
  }

  static std::map<std::string, int> events_by_channel(const fs::path& log) {
    std::map<std::string, int> counts;
    LogReader reader{log};
    while (auto message = reader.next())
      ++counts[message->channel];
    EXPECT_EQ(reader.skipped_bytes(), 0);
    return counts;
  }

  static inline Finished reference_{};
};

TEST_F(ClosedLoop, EstimatesPoseMapAndMarkers) {
  const auto evaluated = run_command((kPrograms / "waymark-evaluate").string() + " run " +
                                     (folder() / "reference").string());
  ASSERT_EQ(evaluated.exit_code, 0) << evaluated.output;
  const auto metrics =
      nlohmann::json::parse(content_of(folder() / "reference" / kRow / "metrics.json"));

  // The corridor is 6 m = 120 px long. Two cells are allowed: the map has whole cells at both ends.
  EXPECT_NEAR(metrics.at("length_px").get<double>(), 120.0, 2.0) << metrics.dump(1);
  // 1 % of odometry scale over 4 m is 4 cm; the error may be larger by less than a cell.
  EXPECT_LT(metrics.at("ate_origin_m").get<double>(), 0.05) << metrics.dump(1);
  EXPECT_EQ(metrics.at("markers_missing"), 0);
  EXPECT_EQ(metrics.at("markers_spurious"), 0);
  EXPECT_LT(metrics.at("marker_error_mean_m").get<double>(), 0.06) << metrics.dump(1);
}

TEST_F(ClosedLoop, WritesEverythingThatScriptsRelyOn) {
  for (const std::string file :
       {"run.lcm", "scenario.toml", "robot.toml", "truth.tum", "truth_markers.csv", "logs/sim.log",
        "waymark/map.pgm", "waymark/map.yaml", "waymark/map.png", "waymark/marker_layer.png",
        "waymark/trajectory.tum", "waymark/markers.csv", "waymark/graph.g2o"}) {
    EXPECT_TRUE(fs::exists(folder() / "reference" / file)) << file;
  }
  for (const auto& entry : fs::recursive_directory_iterator{folder() / "reference"}) {
    EXPECT_THAT(entry.path().extension(),
                ::testing::AnyOf(".lcm", ".toml", ".tum", ".csv", ".log", ".pgm", ".yaml", ".png",
                                 ".json", ".md", ".g2o", ""))
        << "left behind: " << entry.path();
  }
}

TEST_F(ClosedLoop, TheLogHasDataChannelsOnlyInOrderToATenthOfASecond) {
  LogReader reader{folder() / "reference/run.lcm"};
  std::optional<Message> last;
  while (auto message = reader.next()) {
    EXPECT_THAT(message->channel, ::testing::Not(::testing::AnyOf("TICK", "ACK", "SLAM_STATUS")));
    EXPECT_EQ(time_of(message->payload), message->time);
    // Messages that slam publishes for a scan may be recorded in the tick behind it, 0.1 s later.
    if (last) {
      EXPECT_LE(last->time, message->time + 100ms);
    }
    last = message;
  }
}

TEST_F(ClosedLoop, PausingEachProcessGivesTheSameBytes) {
  auto run = launch_in_background("stopped");
  for (const std::string program : {"detector", "slam", "viewer", "recorder"}) {
    const pid_t pid = process_of_run("stopped", program);
    kill(pid, SIGSTOP);
    std::this_thread::sleep_for(400ms);
    kill(pid, SIGCONT);
  }
  const Finished finished = run.get();
  ASSERT_EQ(finished.exit_code, 0) << finished.output;
  expect_same_result("stopped");
}

TEST_F(ClosedLoop, AKilledDetectorIsRestartedAndChangesNothing) {
  auto run = launch_in_background("detector-killed");
  kill(process_of_run("detector-killed", "detector"), SIGKILL);
  const Finished finished = run.get();
  ASSERT_EQ(finished.exit_code, 0) << finished.output;
  EXPECT_THAT(finished.output, HasSubstr("detector"));
  expect_same_result("detector-killed");
}

TEST_F(ClosedLoop, AKilledViewerIsRestartedAndTheFilesAreWhole) {
  auto run = launch_in_background("viewer-killed");
  kill(process_of_run("viewer-killed", "viewer"), SIGKILL);
  const Finished finished = run.get();
  ASSERT_EQ(finished.exit_code, 0) << finished.output;
  expect_same_result("viewer-killed");
}

TEST_F(ClosedLoop, AKilledSlamEndsTheRunAndIsReported) {
  auto run = launch_in_background("slam-killed");
  kill(process_of_run("slam-killed", "slam"), SIGKILL);
  const Finished finished = run.get();
  EXPECT_EQ(finished.exit_code, 3);
  EXPECT_THAT(finished.output, HasSubstr("slam was killed by SIGKILL"));
  EXPECT_FALSE(wait_for_process({"waymark-", (folder() / "slam-killed").string()}, 0s));
}

TEST_F(ClosedLoop, AReplayGivesTheSameMapAsTheLiveRun) {
  const auto replayed =
      run_command((kSource / "deploy/replay.sh").string() + " " +
                  (folder() / "reference/run.lcm").string() + " --estimator " + kRow +
                  " --row replayed --set slam.seed=1 --out " + (folder() / "reference").string());
  ASSERT_EQ(replayed.exit_code, 0) << replayed.output;
  for (const std::string file : {"map.pgm", "map.yaml", "trajectory.tum", "markers.csv"}) {
    EXPECT_TRUE(content_of(folder() / "reference/replayed" / file) ==
                content_of(folder() / "reference" / kRow / file))
        << file;
  }
}

/// A short drive with faults, in place of the scenarios of deploy/sweep.sh, which take hours.
TEST_F(ClosedLoop, WaymarkIsAccurateDespiteFaultyMessages) {
  const std::string variants = (kSource / "tests/data/faults/short.toml").string();
  const std::string faults = (kPrograms / "waymark-faults").string();
  std::istringstream names{run_command(faults + " --variants " + variants + " --list").output};
  int count = 0;
  for (std::string name; std::getline(names, name); ++count) {
    const std::string run = (folder() / ("faulty-" + name)).string();
    const auto finished = run_command(faults + " " + (folder() / "reference").string() +
                                      " --variants " + variants + " --variant " + name + " --out " +
                                      run + " && " + (kSource / "deploy/replay.sh").string() + " " +
                                      run + "/run.lcm --estimator waymark && " +
                                      (kPrograms / "waymark-evaluate").string() + " run " + run);
    ASSERT_EQ(finished.exit_code, 0) << name << ": " << finished.output;
    const auto metrics = nlohmann::json::parse(content_of(fs::path{run} / "waymark/metrics.json"));
    EXPECT_FALSE(metrics.at("expectations").empty()) << name;
    for (const auto& figure : metrics.at("expectations"))
      EXPECT_TRUE(figure.at("hit")) << name << ": " << figure.dump();
  }
  EXPECT_GE(count, 5);
}

TEST_F(ClosedLoop, InjectedAndGarbageMessagesChangeNoResult) {
  PrivateNetwork network;
  auto run = launch_in_background("hostile", "--lcm-url '" + network.url() + "'");
  process_of_run("hostile", "slam");
  pose2D_t stranger{};
  stranger.utime = 2'000'000;
  stranger.x = 99.0F;
  const auto valid = encode(channels::kOdometry, stranger).payload;
  for (int i = 0; i < 2000 && run.wait_for(0s) != std::future_status::ready; ++i) {
    for (const std::string channel : {"LIDAR", "ODOMETRY", "CAMERA", "MARKERS", "TICK", "ACK",
                                      "SLAM_MAP", "SLAM_ESTIMATE", "TRUE_POSE"}) {
      network.send_datagram(lcm_datagram(channel, valid));
      auto garbage = valid;
      garbage[static_cast<std::size_t>(i) % garbage.size()] ^= 0xff;
      garbage.resize(garbage.size() + static_cast<std::size_t>(i % 50));
      network.send_datagram(lcm_datagram(channel, garbage));
    }
    std::this_thread::sleep_for(1ms);
  }
  const Finished finished = run.get();
  ASSERT_EQ(finished.exit_code, 0) << finished.output;
  expect_same_result("hostile");
}

TEST_F(ClosedLoop, TwoStacksAtOnceDoNotDisturbEachOther) {
  auto first = launch_in_background("twin-1");
  auto second = launch_in_background("twin-2");
  EXPECT_EQ(first.get().exit_code, 0);
  EXPECT_EQ(second.get().exit_code, 0);
  expect_same_result("twin-1");
  expect_same_result("twin-2");
}

TEST_F(ClosedLoop, InRealTimeEveryDataMessageOfLockstepIsRecorded) {
  const Finished finished = launch("real-time", "--real-time");
  ASSERT_EQ(finished.exit_code, 0) << finished.output;
  const auto lockstep = events_by_channel(folder() / "reference/run.lcm");
  const auto real_time = events_by_channel(folder() / "real-time/run.lcm");
  for (const std::string channel :
       {"CAMERA", "LIDAR", "ODOMETRY", "MARKERS", "TRUE_POSE", "SLAM_POSE", "SLAM_ESTIMATE",
        "SLAM_MARKERS", "SLAM_TRAJECTORY"}) {
    EXPECT_EQ(real_time.at(channel), lockstep.at(channel)) << channel;
  }
}

TEST_F(ClosedLoop, WithBlankPlatesNoMarkerIsDetected) {
  const fs::path scenario = folder() / "blank.toml";
  std::ofstream{scenario} << content_of(kSource / "tests/data/scenarios/short.toml") << "\n";
  const std::string text = content_of(scenario);
  std::ofstream{scenario} << text.substr(0, text.find("[markers]")) << "[markers]\nblank = true\n"
                          << text.substr(text.find("[markers]") + 9);
  const Finished finished =
      run_command((kSource / "deploy/launch.sh").string() + " " + scenario.string() +
                  " --estimator odometry --out " + (folder() / "blank").string());
  ASSERT_EQ(finished.exit_code, 0) << finished.output;
  LogReader reader{folder() / "blank/run.lcm"};
  int frames = 0;
  while (auto message =
             reader.next([](std::string_view channel) { return channel == "MARKERS"; })) {
    const auto markers = decode<marker_detections_t>(message->payload);
    ASSERT_TRUE(markers.message);
    EXPECT_EQ(markers.message->num_detections, 0);
    ++frames;
  }
  EXPECT_GT(frames, 50);
}

// LCM's own tools on our runs.
TEST_F(ClosedLoop, LcmLogplayerAndLoggerWork) {
  PrivateNetwork network;
  const fs::path copy = folder() / "logger.lcm";
  auto logger = std::async(std::launch::async, [&] {
    return run_command("exec lcm-logger -q -f --lcm-url='" + network.url() + "' " + copy.string());
  });
  const auto pid = wait_for_process({"lcm-logger", copy.string()}, 10s);
  ASSERT_TRUE(pid);
  std::this_thread::sleep_for(500ms);
  const auto played = run_command("lcm-logplayer -s 2 -l '" + network.url() + "' " +
                                  (folder() / "reference/run.lcm").string());
  EXPECT_EQ(played.exit_code, 0) << played.output;
  std::this_thread::sleep_for(500ms);
  kill(*pid, SIGTERM);
  logger.get();
  const auto original = events_by_channel(folder() / "reference/run.lcm");
  const auto copied = events_by_channel(copy);
  EXPECT_EQ(copied.at("LIDAR"), original.at("LIDAR"));
  EXPECT_EQ(copied.at("ODOMETRY"), original.at("ODOMETRY"));
}

}  // namespace
}  // namespace waymark
