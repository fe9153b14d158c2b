// SPDX-License-Identifier: BSD-3-Clause
// What a slam that is started again continues, and which map files it keeps.
#include "common/random/random.hpp"
#include "slam/last_pose.hpp"
#include "unit/slam/map_drives.hpp"

#include <gmock/gmock.h>

namespace waymark {
namespace {

namespace fs = std::filesystem;
using test::config_for;
using ::testing::HasSubstr;

Message save_at(double time_s, const std::string& name) {
  command_t command{};
  command.utime = static_cast<std::int64_t>(1e6 * time_s);
  command.command_id = command.utime;
  command.kind = command_t::KIND_SAVE_MAP;
  command.in_tick = 1;
  command.name = name;
  return encode(channels::kSlamCommand, command);
}

/// A slam whose process is killed: the node is never finished.
void drive_until_killed(const SlamConfig& config, const std::vector<Message>& messages) {
  Inbox inbox;
  Outbox outbox;
  SlamNode killed{config, inbox, outbox};
  for (const Message& message : messages)
    inbox.deliver(message);
}

class Restart : public test::SavedMap {
 protected:
  void SetUp() override {
    folder_ = fs::path{::testing::TempDir()} / ("restart_" + std::to_string(::getpid()));
    fs::create_directories(folder_);
  }

  void TearDown() override { fs::remove_all(folder_); }

  /// A robot whose slam is always started in this way.
  SlamConfig robot(MapMode mode, const fs::path& map) const {
    SlamConfig config = config_for(mode, map, StartKind::kLast);
    config.slam.start.kind = StartKind::kLast;
    config.slam.state_folder = folder_;
    config.slam.commands = true;
    return config;
  }

  std::vector<Message> messages_with(const Message& command, double to_s) const {
    std::vector<Message> messages = messages_of(*drive_, 0.0, to_s);
    messages.push_back(command);
    std::sort(messages.begin(), messages.end(), comes_before);
    return messages;
  }

  fs::path folder_{};
};

TEST_F(Restart, AfterANamedSaveTheMapThatWasBeingDrawnIsContinued) {
  SlamConfig config = robot(MapMode::kMap, folder_ / "unfinished.map.lcm");
  config.slam.save_map_every_s = 5.0;
  drive_until_killed(config, messages_with(save_at(18.0, "named"), 19.5));
  ASSERT_NE(read_map_file(folder_ / "named.map.lcm").map.map_id,
            read_map_file(config.save_map).map.map_id);

  const test::Drive rest = test::drive_through(config, messages_of(*drive_, 21.0));

  EXPECT_EQ(test::with_pose(rest), rest.estimates.size());
  EXPECT_LT(test::worst_error_m(rest, *drive_, test::map_from_world(*drive_)), 0.1);
  EXPECT_EQ(read_map_file(config.save_map).map.landmarks.size(),
            test::corridor_of(1).markers.size());
}

TEST_F(Restart, AfterANamedSaveTheLastPoseHoldsInTheLoadedMapAndInTheSavedOne) {
  SlamConfig config = robot(MapMode::kExtend, *file_);
  drive_until_killed(config, messages_with(save_at(18.0, "named"), 19.5));
  for (const fs::path& map : {*file_, folder_ / "named.map.lcm"}) {
    config.load_map = map;
    ::testing::internal::CaptureStdout();
    drive_until_killed(config, messages_of(*drive_, 20.0, 20.5));
    EXPECT_THAT(::testing::internal::GetCapturedStdout(), HasSubstr("resumes at")) << map;
  }
}

TEST_F(Restart, AMapThatIsNotContinuedIsKeptUnderAnotherName) {
  const SlamConfig config = robot(MapMode::kMap, folder_ / "old.map.lcm");
  const fs::path kept = folder_ / "old.map.lcm.1";
  fs::copy_file(*file_, config.save_map);
  const std::int64_t old_id = read_map_file(config.save_map).map.map_id;

  ::testing::internal::CaptureStdout();
  test::drive_through(config, messages_of(*drive_, 0.0, 5.0));

  EXPECT_THAT(::testing::internal::GetCapturedStdout(), HasSubstr("there is no last pose"));
  EXPECT_NE(read_map_file(config.save_map).map.map_id, old_id);
  ASSERT_TRUE(fs::exists(kept));
  EXPECT_EQ(read_map_file(kept).map.map_id, old_id);
}

TEST_F(Restart, EveryMapThatIsNotContinuedIsKept) {
  const SlamConfig config = robot(MapMode::kMap, folder_ / "old.map.lcm");
  fs::copy_file(*file_, config.save_map);
  for (int days = 0; days < 2; ++days) {
    fs::remove(last_pose_file(folder_));
    test::drive_through(config, messages_of(*drive_, 0.0, 5.0));
  }
  EXPECT_TRUE(fs::exists(folder_ / "old.map.lcm.1"));
  EXPECT_TRUE(fs::exists(folder_ / "old.map.lcm.2"));
}

/// From this time on the walls in the scans are blurred.
std::vector<Message> blurred_from(double time_s, std::vector<Message> messages) {
  Random random{{1}};
  for (Message& message : messages) {
    if (message.channel != channels::kLidar.name || to_seconds(message.time) < time_s) continue;
    planar_lidar_t scan = *decode<planar_lidar_t>(message.payload).message;
    for (float& range_m : scan.ranges)
      range_m += static_cast<float>(random.uniform(-0.1, 0.1));
    message = encode(channels::kLidar, scan);
  }
  return messages;
}

TEST_F(Restart, AMapThatIsSavedWhileThePoseIsLostKeepsTheLastKnownPose) {
  SlamConfig config = robot(MapMode::kMap, folder_ / "day.map.lcm");
  config.slam.save_map_every_s = 2.0;
  config.slam.waymark.lost_inlier_share = 0.9;

  const test::Drive drive =
      test::drive_through(config, blurred_from(12.0, messages_of(*drive_, 0.0, 15.0)));

  ASSERT_EQ(drive.estimates.back().health, slam_estimate_t::HEALTH_LOST);
  const auto last = read_last_pose(folder_);
  ASSERT_TRUE(last);
  EXPECT_TRUE(is_in_map(*last, read_map_file(config.save_map).map.map_id));
  EXPECT_LT(to_us(last->time), drive.estimates.back().utime);
}

// Saved a second time in one run, and continued by a second run.
TEST_F(Restart, AMapThatIsContinuedIsReplaced) {
  SlamConfig config = robot(MapMode::kMap, folder_ / "day.map.lcm");
  config.slam.save_map_every_s = 2.0;
  test::drive_through(config, messages_of(*drive_, 0.0, 8.0));
  test::drive_through(config, messages_of(*drive_, 8.5, 12.0));
  EXPECT_FALSE(fs::exists(folder_ / "day.map.lcm.1"));
}

}  // namespace
}  // namespace waymark
