// SPDX-License-Identifier: BSD-3-Clause
// Start poses and commanded poses that the scans refute.
#include "common/runtime/run_process.hpp"
#include "unit/slam/map_drives.hpp"

#include <gtest/gtest.h>

namespace waymark {
namespace {

using test::config_for;
using test::map_from_world;

constexpr std::int64_t kCommand_us = 12'000'000;
constexpr std::int64_t kNever_us = 1'000'000'000;

class WrongStart : public test::SavedMap {
 protected:
  /// To localise at the origin, with this heading.
  static SlamConfig start_with(double yaw_rad) {
    SlamConfig config = config_for(MapMode::kLocalise, *file_, StartKind::kPose);
    config.slam.start.yaw_rad = yaw_rad;
    config.slam.start.sigma_m = config.slam.start.sigma_rad = 0.05;
    config.slam.commands = true;
    return config;
  }

  static std::vector<Message> messages_with_markers_from(std::int64_t first_us) {
    std::vector<Message> messages = messages_of(*drive_);
    std::erase_if(messages, [&](const Message& message) {
      return message.channel == channels::kMarkers.name &&
             message.time < timestamp_from_us(first_us);
    });
    return messages;
  }

  /// Localises without markers; the true position is commanded later.
  static test::Drive drive_from(double start_yaw_rad, double commanded_yaw_rad) {
    std::vector<Message> messages = messages_with_markers_from(kNever_us);
    const Se2 there = map_from_world(*drive_) * test::true_pose(*drive_, kCommand_us);
    command_t command = test::pose_command(there * Se2{0.0, 0.0, commanded_yaw_rad});
    command.utime = kCommand_us;
    command.in_tick = 1;
    messages.push_back(encode(channels::kSlamCommand, command));
    std::sort(messages.begin(), messages.end(), comes_before);
    return test::drive_through(start_with(start_yaw_rad), messages);
  }

  /// Share of the estimates between two times that have no pose, or say that it is lost.
  static double unknown_share(const test::Drive& drive, std::int64_t from_us, std::int64_t to_us) {
    double unknown = 0.0;
    double all = 0.0;
    for (const slam_estimate_t& estimate : drive.estimates) {
      if (estimate.utime < from_us || estimate.utime > to_us) continue;
      all += 1.0;
      if (estimate.has_pose == 0 || estimate.health == slam_estimate_t::HEALTH_LOST) unknown += 1.0;
    }
    return unknown / all;
  }
};

TEST_F(WrongStart, ARightPoseEndsWhatAWrongStartHasSaid) {
  const test::Drive drive = drive_from(0.5 * std::numbers::pi, 0.0);
  EXPECT_GT(unknown_share(drive, 9'000'000, kCommand_us - 1), 0.9);
  EXPECT_LT(unknown_share(drive, kCommand_us + 1'000'000, kCommand_us + 8'000'000), 0.1);
}

TEST_F(WrongStart, AWrongPoseIsNoticedAfterALongRightDrive) {
  const test::Drive drive = drive_from(0.0, 0.5 * std::numbers::pi);
  EXPECT_LT(unknown_share(drive, 1'000'000, kCommand_us - 1), 0.1);
  EXPECT_GT(unknown_share(drive, kCommand_us + 5'000'000, kCommand_us + 10'000'000), 0.9);
}

/// Of an MBot's app. Slam has given its start pose up before.
TEST_F(WrongStart, AResetBeginsAtTheConfiguredStart) {
  SlamConfig config = start_with(0.5 * std::numbers::pi);
  ProcessOptions options;
  options.config_sources.files = {WAYMARK_SOURCE_DIR "/deploy/mbot.toml"};
  config.channels = process_config_from<SlamConfig>(options).own.channels;
  std::vector<Message> messages = messages_with_markers_from(kNever_us);
  mbot_slam_reset_t reset{};
  reset.utime = kCommand_us;
  reset.slam_mode = slam_status_t::MODE_LOCALISATION_ONLY;
  messages.push_back(encode(channels::kMbotSystemReset, reset));
  std::sort(messages.begin(), messages.end(), comes_before);
  const test::Drive drive = test::drive_through(config, messages);
  EXPECT_GT(unknown_share(drive, 9'000'000, kCommand_us - 1), 0.9);
  EXPECT_LT(unknown_share(drive, kCommand_us + 200'000, kCommand_us + 1'000'000), 0.1);
}

TEST_F(WrongStart, ARefutedStartIsGivenUpAndTheRobotIsFoundByMarkers) {
  const std::int64_t first_marker_us = 15'000'000;
  test::Drive drive = test::drive_through(start_with(0.5 * std::numbers::pi),
                                          messages_with_markers_from(first_marker_us));
  EXPECT_EQ(unknown_share(drive, 10'000'000, first_marker_us - 1), 1.0);
  ASSERT_EQ(drive.estimates.back().has_pose, 1);
  EXPECT_EQ(drive.estimates.back().health, slam_estimate_t::HEALTH_TRACKING);
  std::erase_if(drive.estimates,
                [&](const slam_estimate_t& estimate) { return estimate.utime < first_marker_us; });
  EXPECT_GT(test::with_pose(drive), drive.estimates.size() / 2);
  EXPECT_LT(test::worst_error_m(drive, *drive_, map_from_world(*drive_)), 0.1);
}

}  // namespace
}  // namespace waymark
