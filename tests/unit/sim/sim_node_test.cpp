// SPDX-License-Identifier: BSD-3-Clause
#include "sim/sim_node.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

namespace waymark {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

std::string content(const std::filesystem::path& path) {
  std::stringstream text;
  text << std::ifstream{path}.rdbuf();
  return text.str();
}

SimConfig short_run() {
  SimConfig config{};
  config.world.length_m = 6.0;
  config.markers.last_m = 4.0;
  config.route.end_x_m = 1.1;
  config.route.settle_s = 0.0;
  config.robot.camera.width_px = 160;
  config.robot.camera.height_px = 120;
  return config;
}

TEST(SimNode, MessagesDecodeAndFitADatagram) {
  Inbox inbox;
  SimNode node{short_run(), inbox};
  Timestamp tick_end{};
  const std::vector<Message> messages = node.advance(tick_end);

  EXPECT_EQ(to_us(tick_end), 100'000);
  std::map<std::string, int> counts;
  for (const Message& message : messages) {
    ++counts[message.channel];
    EXPECT_LE(message.payload.size(), kMaxPayloadBytes);
    EXPECT_LT(message.time, tick_end);
    if (message.channel == "CAMERA") {
      EXPECT_EQ(decode<image_t>(message.payload).reason, RejectReason::kNone);
    }
    if (message.channel == "LIDAR") {
      EXPECT_EQ(decode<planar_lidar_t>(message.payload).reason, RejectReason::kNone);
    }
  }
  EXPECT_EQ(counts, (std::map<std::string, int>{
                        {"CAMERA", 1}, {"LIDAR", 1}, {"ODOMETRY", 3}, {"TRUE_POSE", 3}}));
}

TEST(SimNode, RollingScansAreMbotMessages) {
  SimConfig config = short_run();
  config.run.rolling_scan = true;
  Inbox inbox;
  SimNode node{config, inbox};
  Timestamp tick_end{};
  node.advance(tick_end);
  int scans = 0;
  for (const Message& message : node.advance(tick_end)) {
    if (message.channel != "LIDAR") continue;
    ++scans;
    EXPECT_EQ(decode<lidar_t>(message.payload).reason, RejectReason::kNone);
  }
  EXPECT_EQ(scans, 1);
}

TEST(SimNode, WritesTruthFilesAndARobotFileWithoutTruth) {
  SimConfig config = short_run();
  config.out_dir = std::filesystem::path{::testing::TempDir()} / "sim_node_test";
  std::filesystem::remove_all(config.out_dir);
  Inbox inbox;
  SimNode node{config, inbox};
  node.begin();
  Timestamp tick_end{};
  int ticks = 0;
  while (!node.finished() && ++ticks < 100)
    node.advance(tick_end);
  EXPECT_FALSE(std::filesystem::exists(config.out_dir / "truth.tum"));
  node.finish();

  const auto again = load_config<Scenario>({{config.out_dir / "scenario.toml"}, {}});
  EXPECT_EQ(dump_config(again), dump_config(config));
  EXPECT_THAT(content(config.out_dir / "robot.toml"), Not(HasSubstr("[world]")));
  EXPECT_THAT(content(config.out_dir / "robot.toml"), Not(HasSubstr("[markers]")));
  EXPECT_EQ(content(config.out_dir / "truth_markers.csv"),
            "id,instance,x_m,y_m,yaw_rad\n"
            "0,0,4.000000,0.998000,-1.570796327\n"
            "1,0,4.000000,-0.998000,1.570796327\n");
  const std::string truth = content(config.out_dir / "truth.tum");
  EXPECT_EQ(std::count(truth.begin(), truth.end(), '\n'), 3 * ticks);
  EXPECT_THAT(truth, ::testing::StartsWith("0.000000 1.0000"));
}

TEST(SimNode, AFailedStartLeavesExistingFiles) {
  SimConfig config = short_run();
  config.out_dir = std::filesystem::path{::testing::TempDir()} / "sim_node_start_test";
  std::filesystem::remove_all(config.out_dir);
  std::filesystem::create_directories(config.out_dir);
  for (const std::string_view file : SimNode::kFiles)
    std::ofstream{config.out_dir / file} << "of an earlier run";
  Inbox inbox;
  { const SimNode never_begun{config, inbox}; }
  for (const std::string_view file : SimNode::kFiles)
    EXPECT_EQ(content(config.out_dir / file), "of an earlier run") << file;
  std::filesystem::remove_all(config.out_dir);
}

TEST(SimNode, ARunThatFailsLeavesNoTruthOfAnEarlierRun) {
  SimConfig config = short_run();
  config.route.duration_s = 0.1;
  config.out_dir = std::filesystem::path{::testing::TempDir()} / "sim_node_failed_run_test";
  std::filesystem::remove_all(config.out_dir);
  std::filesystem::create_directories(config.out_dir);
  for (const std::string_view file : SimNode::kFiles)
    std::ofstream{config.out_dir / file} << "of an earlier run";
  Inbox inbox;
  SimNode node{config, inbox};
  node.begin();
  Timestamp tick_end{};
  EXPECT_THROW(
      {
        for (int i = 0; i < 4; ++i)
          node.advance(tick_end);
      },
      SimulatorError);
  for (const std::string_view file : SimNode::kFiles)
    EXPECT_THAT(content(config.out_dir / file), Not(HasSubstr("of an earlier run"))) << file;
  EXPECT_FALSE(std::filesystem::exists(config.out_dir / "truth.tum"));
  std::filesystem::remove_all(config.out_dir);
}

TEST(SimNode, MovesOfMarkersAreWritten) {
  SimConfig config = short_run();
  config.out_dir = std::filesystem::path{::testing::TempDir()} / "sim_node_moves_test";
  std::filesystem::remove_all(config.out_dir);
  config.markers.moved = {{1, {.at_s = 0.15}, 1.0, 0.0}};
  Inbox inbox;
  SimNode node{config, inbox};
  node.begin();
  const std::filesystem::path moves = config.out_dir / "truth_marker_moves.csv";
  EXPECT_EQ(content(moves), "t_s,id,instance,x_m,y_m,yaw_rad\n");
  Timestamp tick_end{};
  for (int i = 0; i < 4; ++i)
    node.advance(tick_end);
  EXPECT_EQ(content(moves),
            "t_s,id,instance,x_m,y_m,yaw_rad\n"
            "0.200000,1,0,5.000000,-0.998000,1.570796327\n");
  EXPECT_THAT(content(config.out_dir / "truth_markers.csv"), HasSubstr("1,0,4.000000,-0.998000"));
}

TEST(SimNode, TheRobotFileHasTheNominalCameraOnly) {
  SimConfig config = short_run();
  config.out_dir = std::filesystem::path{::testing::TempDir()} / "sim_node_camera_test";
  config.camera_errors.focal_share = 0.005;
  Inbox inbox;
  SimNode node{config, inbox};
  node.begin();
  const std::string robot_toml = content(config.out_dir / "robot.toml");
  EXPECT_THAT(robot_toml, HasSubstr("fx_px = 530.4663 "));
  EXPECT_THAT(robot_toml, Not(HasSubstr("camera_errors")));
}

TEST(SimNode, AnUnwritableFolderIsASetupError) {
  SimConfig config = short_run();
  config.out_dir = "/proc/no_such_folder";
  Inbox inbox;
  EXPECT_THROW((SimNode{config, inbox}), SetupError);
}

TEST(SimNode, RunIdsDifferBetweenScenarios) {
  Inbox inbox;
  SimConfig other = short_run();
  other.run.seed = 2;
  const std::int64_t run_id = SimNode{short_run(), inbox}.run_id();
  EXPECT_EQ(run_id, (SimNode{short_run(), inbox}.run_id()));
  EXPECT_NE(run_id, (SimNode{other, inbox}.run_id()));
}

TEST(SimNode, FollowsDriveCommandsIfTheScenarioSaysSo) {
  SimConfig config = short_run();
  config.route.source = DriveSource::kCommand;
  config.route.duration_s = 2.0;
  Inbox inbox;
  SimNode node{config, inbox};
  twist2D_t command{};
  command.utime = 1;
  command.vx = 0.2F;
  inbox.deliver(encode(channels::kDriveCommand, command));
  Timestamp tick_end{};
  while (!node.finished())
    node.advance(tick_end);
  command.utime = 0;
  inbox.deliver(encode(channels::kDriveCommand, command));
  EXPECT_EQ(inbox.counters().get("DRIVE_COMMAND obeyed"), 1);
  EXPECT_EQ(inbox.counters().get("DRIVE_COMMAND dropped: a newer one has acted"), 1);
  EXPECT_EQ(node.progress_text(), "at (1.1, 0.0) m");
}

}  // namespace
}  // namespace waymark
