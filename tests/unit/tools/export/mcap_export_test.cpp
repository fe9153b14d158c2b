// SPDX-License-Identifier: BSD-3-Clause
#include "export/mcap_export.hpp"

#include "unit/tools/export/mcap_messages.hpp"
#include "unit/tools/temporary_folder.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace waymark::exporting {
namespace {

using ::testing::IsEmpty;
using ::testing::SizeIs;

constexpr std::int64_t kSecond_us = 1'000'000;

pose2D_t pose_at(std::int64_t utime, double x_m) {
  pose2D_t message{};
  message.utime = utime;
  message.x = static_cast<float>(x_m);
  return message;
}

slam_estimate_t estimate_at(std::int64_t utime, std::int64_t map_id, double x_m) {
  slam_estimate_t message{};
  message.utime = utime;
  message.map_id = map_id;
  message.has_pose = 1;
  message.x_m = x_m;
  return message;
}

map_tiles_t tile_at(std::int64_t utime, std::int64_t map_id, int tile_x) {
  map_tiles_t message{};
  message.utime = utime;
  message.map_id = map_id;
  message.num_parts = 1;
  message.resolution_m = 0.5;
  message.tile_size_cells = 2;
  message.num_tiles = 1;
  message.tiles.resize(1);
  message.tiles[0] = {};
  message.tiles[0].tile_x = tile_x;
  message.tiles[0].num_cells = 4;
  message.tiles[0].occupancy = {0, 0, 100, 100};
  message.tiles[0].marker_ids = {-1, -1, -1, -1};
  return message;
}

marker_map_t marker_at(std::int64_t utime, std::int64_t map_id) {
  marker_map_t message{};
  message.utime = utime;
  message.map_id = map_id;
  message.num_parts = 1;
  message.num_landmarks = 1;
  message.landmarks.resize(1);
  message.landmarks[0] = {};
  return message;
}

/// An export into a file that is read back.
class Export : public ::testing::Test {
 protected:
  template <class Type>
  void send(Channel<Type> channel, const Type& message) {
    inbox_.deliver(encode(channel, message));
  }

  McapMessages exported() {
    node_.finish();
    return McapMessages{file_};
  }

  evaluate::TemporaryFolder folder_{};
  std::filesystem::path file_{folder_.path() / "run.mcap"};
  Inbox inbox_{};
  McapExport node_{file_, inbox_};
};

/// x of each transform between two frames.
std::vector<double> transforms(McapMessages& messages, const std::string& parent) {
  std::vector<double> x_m;
  for (const McapMessage& message : messages.on("/tf")) {
    const nlohmann::json& transform = message.content["transforms"][0];
    if (transform["parent_frame_id"] == parent) x_m.push_back(transform["translation"]["x"]);
  }
  return x_m;
}

TEST_F(Export, OdometryMayComeAfterTheEstimate) {
  for (int i = 0; i < 10; ++i) {
    send(channels::kOdometry, pose_at(i * kSecond_us / 10, 0.1 * i));
    send(channels::kTruePose, pose_at(i * kSecond_us / 10, 0.1 * i - 3.0));
    send(channels::kSlamEstimate,
         estimate_at(i * kSecond_us / 10 + kSecond_us / 20, 1, 0.1 * i + 0.05 + 2.0));
  }
  McapMessages messages = exported();
  const auto map_from_odom = transforms(messages, "map");
  EXPECT_THAT(map_from_odom, SizeIs(9));  // nothing follows the last one
  for (const double x_m : map_from_odom)
    EXPECT_NEAR(x_m, 2.0, 1e-6);
  const auto world_from_map = transforms(messages, "world");
  ASSERT_THAT(world_from_map, SizeIs(1));
  EXPECT_NEAR(world_from_map[0], -5.0, 1e-6);
  EXPECT_EQ(inbox_.counters().get("SLAM_ESTIMATE without ODOMETRY around it"), 1);
  EXPECT_EQ(inbox_.counters().total(CountKind::kLoss), 1);
}

TEST_F(Export, AnotherMapReplacesTheOneBefore) {
  send(channels::kTruePose, pose_at(0, 0.0));
  send(channels::kSlamEstimate, estimate_at(0, 1, 0.0));
  send(channels::kSlamMap, tile_at(0, 1, 0));
  send(channels::kSlamMarkers, marker_at(0, 1));
  send(channels::kTruePose, pose_at(kSecond_us, 1.0));
  send(channels::kSlamEstimate, estimate_at(kSecond_us, 2, 0.0));
  send(channels::kSlamMap, tile_at(kSecond_us, 2, 5));
  send(channels::kSlamMap, tile_at(kSecond_us / 2, 1, 0));  // late, of the map before
  McapMessages messages = exported();

  ASSERT_THAT(messages.on("/map"), SizeIs(2));
  const nlohmann::json& grid = messages.on("/map")[1].content;
  EXPECT_EQ(grid["column_count"], 2);
  EXPECT_EQ(grid["pose"]["position"]["x"], 5.0);

  ASSERT_THAT(messages.on("/markers"), SizeIs(2));
  EXPECT_THAT(messages.on("/markers")[1].content["deletions"], SizeIs(1));
  EXPECT_THAT(messages.on("/markers")[1].content["entities"], IsEmpty());

  EXPECT_THAT(transforms(messages, "world"), ::testing::ElementsAre(0.0, 1.0));
  EXPECT_EQ(inbox_.counters().get("messages of an earlier map left out"), 1);
}

TEST_F(Export, AnotherMapIsFollowedWhenTheClockWasSetBack) {
  send(channels::kSlamEstimate, estimate_at(100 * kSecond_us, 1, 0.0));
  send(channels::kSlamMap, tile_at(100 * kSecond_us, 1, 0));
  for (int i = 0; i < 30; ++i)
    send(channels::kSlamEstimate, estimate_at(i * kSecond_us / 10, 2, 0.0));
  send(channels::kSlamMap, tile_at(3 * kSecond_us, 2, 5));
  send(channels::kSlamMap, tile_at(5 * kSecond_us, 2, 6));
  McapMessages messages = exported();
  EXPECT_THAT(messages.on("/map"), SizeIs(3));
  EXPECT_THAT(messages.on("/pose"), SizeIs(1 + 11));  // the clock step is recognised after 20
}

TEST_F(Export, GridsAreStillWrittenAfterTheClockWasSetBack) {
  for (const int time_s : {100, 3, 5})
    send(channels::kSlamMap, tile_at(time_s * kSecond_us, 1, 0));
  EXPECT_THAT(exported().on("/map"), SizeIs(3));
}

TEST_F(Export, AScanHasTheAnglesOfItsBeams) {
  annotated_scan_t scan{};
  scan.num_beams = 3;
  scan.angles = {0.1F, 0.0F, 6.1831853F};  // clockwise over zero
  scan.ranges = {1.0F, 2.0F, 3.0F};
  scan.marker_ids = {-1, -1, -1};
  send(channels::kSlamScan, scan);
  McapMessages messages = exported();
  ASSERT_THAT(messages.on("/scan"), SizeIs(1));
  const nlohmann::json& written = messages.on("/scan")[0].content;
  EXPECT_NEAR(written["start_angle"], -0.1, 1e-6);
  EXPECT_NEAR(written["end_angle"], 0.1, 1e-6);
  EXPECT_EQ(written["ranges"], (nlohmann::json{3.0, 2.0, 1.0}));
}

}  // namespace
}  // namespace waymark::exporting
