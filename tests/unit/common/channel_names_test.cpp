// SPDX-License-Identifier: BSD-3-Clause
// Names of channels on the network, as configured.
#include "common/bus/channel_names.hpp"

#include "common/messages/channels.hpp"
#include "common/runtime/run_process.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <set>
#include <string>

namespace waymark {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

struct Nothing {
  void describe(Fields&) {}
};

ProcessConfig<Nothing> load(const ConfigSources& sources) {
  return load_config<ProcessConfig<Nothing>>(sources);
}

std::string error_of(const ConfigSources& sources) {
  try {
    load(sources);
  } catch (const ConfigError& error) {
    return error.what();
  }
  return "no error";
}

TEST(ChannelNames, AreTheDefaultsUnlessConfigured) {
  const ChannelNames names = load({}).channels;
  EXPECT_EQ(names.on_network("ODOMETRY"), "ODOMETRY");
  EXPECT_EQ(names.on_network("NO_CHANNEL_OF_OURS"), "NO_CHANNEL_OF_OURS");
  for (const auto channel : {"SLAM_GRID", "MBOT_SLAM_STATUS", "MBOT_SYSTEM_RESET"})
    EXPECT_FALSE(names.uses(channel)) << channel;
}

TEST(ChannelNames, TheShippedMbotFileMapsItsChannels) {
  const std::filesystem::path file = WAYMARK_SOURCE_DIR "/deploy/mbot.toml";
  const ChannelNames names = load({{file}, {}}).channels;
  EXPECT_EQ(names.on_network("ODOMETRY"), "MBOT_ODOMETRY");
  EXPECT_EQ(names.on_network("SLAM_GRID"), "SLAM_MAP");
  EXPECT_NE(names.on_network("SLAM_MAP"), "SLAM_MAP");
  EXPECT_EQ(names.on_network("LIDAR"), "LIDAR");
}

TEST(ChannelNames, TwoChannelsOfOneTypeOnOneNameAreRefusedWithTheirLine) {
  const auto file = std::filesystem::path{::testing::TempDir()} / "channel_names_test.toml";
  std::ofstream{file} << "[channels]\n\nslam_pose = \"TRUE_POSE\"\n";
  EXPECT_THAT(error_of({{file}, {}}),
              AllOf(HasSubstr("channel_names_test.toml:3: channels.slam_pose: got \"TRUE_POSE\""),
                    HasSubstr("channels.true_pose"), HasSubstr("pose2D_t")));
  std::ofstream{file} << "[channels]\nodometry = \"SLAM_POSE\"\n";
  EXPECT_THAT(error_of({{file}, {}}),
              AllOf(HasSubstr("channel_names_test.toml:2: channels.odometry: got \"SLAM_POSE\""),
                    HasSubstr("channels.slam_pose")));
}

TEST(ChannelNames, ChannelsOfDifferentTypesMayShareAName) {
  const ConfigSources sources{{}, {"channels.slam_grid=SLAM_MAP"}};
  EXPECT_EQ(load(sources).channels.on_network("SLAM_GRID"), "SLAM_MAP");
  const std::vector<std::string> sharing{"SLAM_MAP", "SLAM_GRID"};
  EXPECT_EQ(ChannelNames::of_type(sharing, occupancy_grid_t::getHash()), "SLAM_GRID");
  EXPECT_EQ(ChannelNames::of_type(sharing, map_tiles_t::getHash()), "SLAM_MAP");
  EXPECT_EQ(ChannelNames::of_type(sharing, 7), "SLAM_MAP");
}

TEST(ChannelNames, NamesThatLcmRejectsAreRefused) {
  EXPECT_THAT(error_of({{}, {"channels.odometry='MBOT.*'"}}), HasSubstr("letters, digits"));
  EXPECT_THAT(error_of({{}, {"channels.odometry=''"}}), HasSubstr("letters, digits"));
  EXPECT_THAT(error_of({{}, {"channels.odometry=" + std::string(64, 'A')}}), HasSubstr("1 to 63"));
  EXPECT_THAT(error_of({{}, {"channels.odomety=ODO"}}),
              HasSubstr("did you mean channels.odometry"));
}

/// Rows "| `CHANNEL` | `type_t` ..." of lcmtypes/README.md, without the second types.
std::set<std::string> channels_in_readme() {
  std::ifstream file{WAYMARK_SOURCE_DIR "/lcmtypes/README.md"};
  std::set<std::string> rows;
  const std::string start = "| `";
  for (std::string line; std::getline(file, line);) {
    if (!line.starts_with(start)) continue;
    const auto name_end = line.find('`', start.size());
    const auto type = line.find('`', name_end + 1) + 1;
    rows.insert(line.substr(start.size(), name_end - start.size()) + " " +
                line.substr(type, line.find('`', type) - type));
  }
  return rows;
}

TEST(Channels, EveryChannelIsListedInTheReadmeWithItsType) {
  std::set<std::string> listed;
  channels::visit_all([&]<class... Types>(const Channel<Types>&... channels) {
    (listed.insert(std::string{channels.name} + " " + Types::getTypeName()), ...);
  });
  listed.erase("LIDAR lidar_t");  // the second type in LIDAR's row
  EXPECT_EQ(listed, channels_in_readme());
}

TEST(ChannelNames, ChannelsOfTheNetworkCanBeRenamedAndThoseOfFilesCannot) {
  const ChannelNames names =
      load({{},
            {"channels.slam_correction=POSE_CORRECTION", "channels.slam_command=ORDER",
             "channels.slam_reply=ANSWER", "channels.slam_changes=CHANGES",
             "channels.slam_findings=FINDINGS", "channels.map_graph=GRAPH"}})
          .channels;
  EXPECT_EQ(names.on_network("SLAM_CORRECTION"), "POSE_CORRECTION");
  EXPECT_THAT(error_of({{}, {"channels.map_header=HEADER"}}), HasSubstr("channels.map_header"));
}

TEST(ChannelNames, ADumpReadsBackAsTheSame) {
  const std::filesystem::path mbot = WAYMARK_SOURCE_DIR "/deploy/mbot.toml";
  const std::string dumped = dump_config(load({{mbot}, {}}));
  const auto file = std::filesystem::path{::testing::TempDir()} / "channel_names_dump.toml";
  std::ofstream{file} << dumped;
  EXPECT_EQ(dump_config(load({{file}, {}})), dumped);
}

}  // namespace
}  // namespace waymark
