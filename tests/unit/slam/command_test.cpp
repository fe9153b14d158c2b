// SPDX-License-Identifier: BSD-3-Clause
// Commands: what is refused and why, and what the others do.
#include "common/files/whole_file.hpp"
#include "common/lockstep/command_relay.hpp"
#include "slam/command_desk.hpp"
#include "unit/slam/map_drives.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace waymark {
namespace {

using test::config_for;
using test::corridor_of;
using test::pose_command;
namespace fs = std::filesystem;

command_t save_command(const std::string& name) {
  command_t command{};
  command.command_id = 1;
  command.kind = command_t::KIND_SAVE_MAP;
  command.name = name;
  return command;
}

template <class Type>
Message shifted(Channel<Type> channel, const Message& message, std::int64_t by_us) {
  Type body = *decode<Type>(message.payload).message;
  body.utime += by_us;
  return encode(channel, body);
}

std::string why_refused(const command_t& command) {
  try {
    checked(command);
  } catch (const Refusal& refusal) {
    return refusal.what();
  }
  return {};
}

TEST(Command, InvalidMapNamesAreRefused) {
  for (const std::string name : {"a", "Corridor_2-b", "0"})
    EXPECT_EQ(why_refused(save_command(name)), "") << name;
  for (const std::string& name :
       {std::string{}, std::string{"../map"}, std::string{"/tmp/map"}, std::string{"a b"},
        std::string{"."}, std::string{"a.b"}, std::string{"\xc3\xa4"}, std::string(65, 'a')})
    EXPECT_NE(why_refused(save_command(name)).find("letters, digits"), std::string::npos) << name;
}

TEST(Command, InvalidPosesAreRefused) {
  EXPECT_EQ(why_refused(pose_command({1.0, 0.0, 3.0})), "");
  command_t unknown_x = pose_command({});
  unknown_x.pose[0] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_NE(why_refused(unknown_x), "");
  command_t infinite_turn = pose_command({});
  infinite_turn.pose[2] = std::numeric_limits<double>::infinity();
  EXPECT_NE(why_refused(infinite_turn), "");
  EXPECT_NE(why_refused(pose_command({1e7, 0.0, 0.0})), "");
  command_t exact = pose_command({1.0, 0.0, 0.0});
  for (const double sigma : {0.0, -0.1, 1e-300, 1e200}) {
    exact.sigmas[0] = sigma;
    EXPECT_NE(why_refused(exact).find("sigmas must be from 1e-06"), std::string::npos) << sigma;
  }
}

TEST(Command, UnknownKindsAndModesAreRefused) {
  command_t command{};
  for (const int kind : {-128, -1, 0, 5, 127}) {
    command.kind = static_cast<std::int8_t>(kind);
    EXPECT_NE(why_refused(command).find("unknown"), std::string::npos) << kind;
  }
  command.kind = command_t::KIND_SET_MODE;
  EXPECT_NE(why_refused(command).find("unknown"), std::string::npos);
}

TEST(CommandDesk, ARepeatedCommandActsOnceAndIsAnsweredAgain) {
  CommandDesk desk;
  int acted = 0;
  const auto act = [&](const Command&) {
    return std::to_string(++acted);
  };
  const auto first = desk.handle(save_command("a"), timestamp_from_us(1), act);
  const auto again = desk.handle(save_command("a"), timestamp_from_us(2), act);
  EXPECT_EQ(acted, 1);
  ASSERT_TRUE(first && again);
  EXPECT_EQ(again->text, "1");
  EXPECT_EQ(again->state, reply_t::STATE_DONE);
}

TEST(CommandDesk, AFloodIsRefusedWithOneAnswerASecond) {
  CommandDesk desk;
  int acted = 0;
  int answers = 0;
  std::string last;
  for (int i = 0; i < 10000; ++i) {
    command_t command = save_command("a");
    command.command_id = 100 + i;
    const auto reply = desk.handle(command, timestamp_from_us(1'000'000 + i), [&](const Command&) {
      ++acted;
      return std::string{};
    });
    if (!reply) continue;
    ++answers;
    last = reply->text;
  }
  EXPECT_EQ(acted, CommandDesk::kMaxPerSecond);
  EXPECT_EQ(answers, CommandDesk::kMaxPerSecond + 1);
  EXPECT_NE(last.find("more than 5 commands"), std::string::npos);
}

TEST(CommandRelay, StampsQueuedCommandsWithTheTickAndIgnoresItsOwnMessages) {
  Counters counters;
  CommandRelay relay{counters};
  for (int i = 0; i < 20; ++i) {
    command_t command = save_command("a");
    command.command_id = i;
    relay.handle(encode(channels::kSlamCommand, command));
  }
  std::vector<Message> tick;
  relay.move_into(tick, timestamp_from_us(5'000'000));
  ASSERT_EQ(tick.size(), CommandRelay::kMaxPerTick);
  EXPECT_EQ(counters.get("SLAM_COMMAND dropped: too many"), 10);
  EXPECT_EQ(tick.front().time, timestamp_from_us(5'000'000));
  for (const Message& message : tick)
    relay.handle(message);
  std::vector<Message> next;
  relay.move_into(next, timestamp_from_us(6'000'000));
  EXPECT_TRUE(next.empty());
}

class CommandedSlam : public test::SavedMap {
 protected:
  void SetUp() override {
    folder_ = fs::path{::testing::TempDir()} / ("state_" + std::to_string(::getpid()));
  }

  void TearDown() override { fs::remove_all(folder_); }

  /// @param commands  with the time at which they act.
  test::Drive drive_with(SlamConfig config, std::vector<Message> messages,
                         std::vector<std::pair<double, command_t>> commands) {
    config.slam.state_folder = folder_;
    config.slam.commands = true;
    std::int64_t id = 1000;
    for (auto& [time_s, command] : commands) {
      command.utime = static_cast<std::int64_t>(1e6 * time_s);
      command.command_id = ++id;
      command.in_tick = 1;
      messages.push_back(encode(channels::kSlamCommand, command));
    }
    std::sort(messages.begin(), messages.end(), comes_before);
    return test::drive_through(config, messages);
  }

  static std::vector<reply_t> replies_of(const test::Drive& drive) {
    std::vector<reply_t> replies;
    for (const Message& message : drive.messages)
      if (message.channel == channels::kSlamReply.name)
        replies.push_back(*decode<reply_t>(message.payload).message);
    return replies;
  }

  static command_t mode_command(std::int8_t mode) {
    command_t command{};
    command.kind = command_t::KIND_SET_MODE;
    command.mode = mode;
    return command;
  }

  static SlamConfig mapping() { return SlamConfig{}; }

  fs::path folder_{};
};

TEST_F(CommandedSlam, RefusesWhileCommandsAreOff) {
  SlamConfig config = mapping();
  std::vector<Message> messages = messages_of(*drive_, 0.0, 3.0);
  messages.push_back(encode(channels::kSlamCommand, save_command("a")));
  const auto replies = replies_of(test::drive_through(config, messages));
  ASSERT_EQ(replies.size(), 1U);
  EXPECT_EQ(replies[0].state, reply_t::STATE_REFUSED);
  EXPECT_NE(replies[0].text.find("slam.commands = true"), std::string::npos);
}

TEST_F(CommandedSlam, RefusesAPoseBeforeTheSurveysFrameIsKnown) {
  fs::create_directories(folder_);
  const fs::path survey = folder_ / "survey.csv";
  write_whole_file(
      survey, "id,x_m,y_m,yaw_rad,sigma_x_m,sigma_y_m,sigma_yaw_rad\n249,1,2,0,0.01,0.01,0.01\n");
  SlamConfig config = mapping();
  config.robot.markers.survey_file = survey;
  const auto replies = replies_of(
      drive_with(config, messages_of(*drive_, 0.0, 5.0), {{3.0, pose_command({1.0, 0.0, 0.0})}}));
  ASSERT_EQ(replies.size(), 1U);
  EXPECT_EQ(replies[0].state, reply_t::STATE_REFUSED) << replies[0].text;
}

TEST_F(CommandedSlam, SavesAMapThatCanBeLocalisedIn) {
  const test::Drive drive =
      drive_with(mapping(), messages_of(*drive_), {{30.0, save_command("m")}});
  const auto replies = replies_of(drive);
  ASSERT_EQ(replies.size(), 1U);
  EXPECT_EQ(replies[0].state, reply_t::STATE_DONE) << replies[0].text;
  const fs::path map = folder_ / "m.map.lcm";
  EXPECT_GT(read_map_file(map).map.landmarks.size(), 3U);
  const test::SensorLog today = test::drive(corridor_of(2));
  const test::Drive localised =
      test::drive_through(config_for(MapMode::kLocalise, map), messages_of(today, 0.0, 20.0));
  EXPECT_GT(test::with_pose(localised), localised.estimates.size() / 2);
}

TEST_F(CommandedSlam, AResetStartsANewMapAtTheRobot) {
  command_t reset{};
  reset.kind = command_t::KIND_RESET;
  const test::Drive drive = drive_with(mapping(), messages_of(*drive_), {{20.0, reset}});
  EXPECT_NE(drive.estimates.front().map_id, drive.estimates.back().map_id);
  const auto first = std::find_if(drive.estimates.begin(), drive.estimates.end(),
                                  [&](const slam_estimate_t& estimate) {
                                    return estimate.map_id == drive.estimates.back().map_id;
                                  });
  EXPECT_NEAR(first->x_m, 0.0, 1e-3);
  EXPECT_GT(first->utime, 19'500'000);
  EXPECT_LT(drive.markers.size(), corridor_of(1).markers.size());
}

TEST_F(CommandedSlam, MappingCanBeSwitchedToLocalisingInTheMapJustMade) {
  const test::Drive drive = drive_with(mapping(), messages_of(*drive_, 0.0, 18.0),
                                       {{13.0, mode_command(command_t::MODE_EXTEND)},
                                        {14.0, mode_command(command_t::MODE_LOCALISE)},
                                        {14.5, save_command("a")}});
  const auto replies = replies_of(drive);
  ASSERT_EQ(replies.size(), 3U);
  EXPECT_EQ(replies[0].state, reply_t::STATE_REFUSED) << replies[0].text;
  EXPECT_EQ(replies[1].state, reply_t::STATE_DONE) << replies[1].text;
  EXPECT_EQ(replies[2].state, reply_t::STATE_REFUSED) << replies[2].text;
  EXPECT_EQ(drive.estimates.front().map_id, drive.estimates.back().map_id);
  EXPECT_LT(drive.markers.size(), corridor_of(1).markers.size());
  EXPECT_LT(test::worst_error_m(drive, *drive_, test::map_from_world(*drive_)), 0.15);
}

// Carried 3 m back by hand, and set there by a command; odometry does not measure it.
TEST_F(CommandedSlam, AnExtendedMapHasANewId) {
  const test::Drive drive = drive_with(mapping(), messages_of(*drive_, 0.0, 18.0),
                                       {{13.0, mode_command(command_t::MODE_LOCALISE)},
                                        {15.0, mode_command(command_t::MODE_EXTEND)}});
  const auto map_id_at = [&](double time_s) {
    return std::find_if(drive.estimates.begin(), drive.estimates.end(),
                        [&](const slam_estimate_t& estimate) {
                          return static_cast<double>(estimate.utime) > 1e6 * time_s;
                        })
        ->map_id;
  };
  EXPECT_EQ(map_id_at(14.5), map_id_at(12.5));
  EXPECT_NE(map_id_at(15.5), map_id_at(14.5));
}

TEST_F(CommandedSlam, ACommandedPoseIsTheRobotsPose) {
  std::vector<Message> messages = messages_of(*drive_, 0.0, 20.0);
  std::vector<Message> later = messages_of(*drive_, 10.0, 40.0);
  const std::int64_t shift_us = 10'100'000;
  for (Message& message : later) {
    if (message.channel == channels::kLidar.name)
      message = shifted(channels::kLidar, message, shift_us);
    else if (message.channel == channels::kOdometry.name)
      message = shifted(channels::kOdometry, message, shift_us);
    else
      message = shifted(channels::kMarkers, message, shift_us);
    messages.push_back(message);
  }
  const Se2 there = test::map_from_world(*drive_) * test::true_pose(*drive_, 10'200'000);
  const test::Drive drive = drive_with(mapping(), messages, {{20.15, pose_command(there)}});
  const auto replies = replies_of(drive);
  ASSERT_EQ(replies.size(), 1U);
  EXPECT_EQ(replies[0].state, reply_t::STATE_DONE) << replies[0].text;
  for (const slam_estimate_t& estimate : drive.estimates) {
    if (estimate.utime < 20'500'000) continue;
    const Se2 truth =
        test::map_from_world(*drive_) * test::true_pose(*drive_, estimate.utime - shift_us);
    EXPECT_LT(std::hypot(estimate.x_m - truth.x(), estimate.y_m - truth.y()), 0.25)
        << 1e-6 * static_cast<double>(estimate.utime);
  }
}

TEST_F(CommandedSlam, ACommandedPoseWithAnySigmasGivesValidEstimates) {
  for (const double sigma : {1e-300, 1e-6, 1.0, 1e3, 1e6, 1e200}) {
    command_t command = pose_command({1.0, 0.0, 0.5});
    command.sigmas[0] = command.sigmas[1] = sigma;
    const test::Drive drive =
        drive_with(mapping(), messages_of(*drive_, 0.0, 6.0), {{3.0, command}});
    EXPECT_EQ(replies_of(drive).size(), 1U) << sigma;
    EXPECT_GT(drive.estimates.back().utime, 5'000'000) << sigma;
  }
}

// The number of cells of a grid is bounded, so with finer cells the largest grid is smaller in
// metres.
TEST_F(CommandedSlam, APoseBeyondTheLargestGridIsRefused) {
  SlamConfig config = mapping();
  config.slam.grid.resolution_m = 0.02;
  const command_t within = pose_command({420.0, 420.0, 0.0});
  const command_t beyond = pose_command({-1400.0, 0.0, 0.0});
  std::vector<Message> messages = messages_of(*drive_, 0.0, 4.0);
  std::erase_if(messages, [](const Message& message) {
    return message.channel == channels::kMarkers.name;  // would reveal the true pose
  });
  const test::Drive drive = drive_with(config, messages, {{2.0, beyond}, {3.0, within}});
  const auto replies = replies_of(drive);
  ASSERT_EQ(replies.size(), 2U);
  EXPECT_EQ(replies[0].state, reply_t::STATE_REFUSED) << replies[0].text;
  EXPECT_NE(replies[0].text.find("more than 600 m away"), std::string::npos) << replies[0].text;
  EXPECT_EQ(replies[1].state, reply_t::STATE_DONE) << replies[1].text;
  EXPECT_NEAR(drive.estimates.back().x_m, 420.0, 1.0);
}

TEST_F(CommandedSlam, MarkersCorrectACommandedPoseThatIsFarFromTheRobot) {
  const test::Drive drive =
      drive_with(mapping(), messages_of(*drive_), {{3.0, pose_command({40.0, 3.0, 0.0})}});
  const Se2 truth = test::map_from_world(*drive_) * drive_->truth.back().world_from_base;
  EXPECT_NEAR(drive.estimates.back().x_m, truth.x(), 0.05);
  EXPECT_NEAR(drive.estimates.back().y_m, truth.y(), 0.05);
}

// The robot is carried further and further away, until the grid would exceed its largest size.
TEST_F(CommandedSlam, ResultsBeforeTheEstimatorThrowsAreWritten) {
  SlamConfig config = mapping();
  config.slam.grid.resolution_m = 0.005;
  config.slam.state_folder = folder_;
  config.slam.commands = true;
  config.save_map = other_file("thrown");
  std::vector<Message> messages = messages_of(*drive_, 0.0, 9.0);
  std::erase_if(messages, [](const Message& message) {
    return message.channel == channels::kMarkers.name;  // would reveal the true pose
  });
  for (int i = 1; i <= 4; ++i) {
    command_t command = pose_command({100.0 * i, 100.0 * i, 0.0});
    command.command_id = i;
    command.utime = 1'000'000 * (2 * i);
    command.in_tick = 1;
    messages.push_back(encode(channels::kSlamCommand, command));
  }
  std::sort(messages.begin(), messages.end(), comes_before);
  Inbox inbox;
  Outbox outbox;
  SlamNode node{config, inbox, outbox};
  std::string thrown = "nothing";
  for (const Message& message : messages) {
    try {
      inbox.deliver(message);
    } catch (const std::length_error& error) {
      thrown = error.what();
      break;
    }
  }
  EXPECT_THAT(thrown, ::testing::HasSubstr("the map would span more tiles"));
  const auto before = count_by_channel(outbox.take());
  node.finish();
  const std::vector<Message> at_end = outbox.take();
  auto counts = count_by_channel(at_end);
  EXPECT_EQ(counts["SLAM_ESTIMATE"], 0);
  EXPECT_GE(counts["SLAM_MAP"], 1);
  ASSERT_EQ(counts["SLAM_TRAJECTORY"], 1);
  for (const Message& message : at_end) {
    if (message.channel != channels::kSlamTrajectory.name) continue;
    EXPECT_EQ(decode<trajectory_t>(message.payload).message->num_poses, before.at("SLAM_ESTIMATE"));
  }
  EXPECT_GT(read_map_file(config.save_map).map.grid.occupancy.num_tiles(), 100U);
  fs::remove(config.save_map);
}

TEST_F(CommandedSlam, AReplayRepeatsRecordedCommands) {
  const std::vector<std::pair<double, command_t>> commands{
      {15.0, save_command("m")}, {20.0, mode_command(command_t::MODE_LOCALISE)}};
  const test::Drive first = drive_with(mapping(), messages_of(*drive_), commands);
  const test::Drive second = drive_with(mapping(), messages_of(*drive_), commands);
  EXPECT_TRUE(first.messages == second.messages);
}

}  // namespace
}  // namespace waymark
