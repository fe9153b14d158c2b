// SPDX-License-Identifier: BSD-3-Clause
// Slam as an MBot's web app knows it: the map in one datagram, status, reset.
#include "common/runtime/run_process.hpp"
#include "slam/map_publisher.hpp"
#include "unit/slam/slam_run.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <optional>

namespace waymark {
namespace {

std::optional<occupancy_grid_t> last_grid(const std::vector<Message>& output) {
  std::optional<occupancy_grid_t> grid;
  for (const Message& message : output) {
    if (message.channel == "SLAM_GRID") grid = decode<occupancy_grid_t>(message.payload).message;
  }
  return grid;
}

/// Configured for an MBot's web app.
SlamConfig mbot_config() {
  ProcessOptions options;
  options.config_sources.files = {WAYMARK_SOURCE_DIR "/deploy/mbot.toml"};
  return process_config_from<SlamConfig>(options).own;
}

Message reset_message(std::int32_t mode, bool retain_pose) {
  mbot_slam_reset_t message{};
  message.slam_mode = mode;
  message.retain_pose = retain_pose ? 1 : 0;
  return encode(channels::kMbotSystemReset, message);
}

TEST(MbotSlam, TheGridCoversExactlyTheMap) {
  const auto output = Slam{mbot_config()}.feed(messages_of_drive());
  const auto grid = last_grid(output);
  ASSERT_TRUE(grid);
  const auto known_in = [&grid](int first, int step, int count) {
    for (int i = 0; i < count; ++i) {
      if (grid->cells[static_cast<std::size_t>(first + i * step)] != 0) return true;
    }
    return false;
  };
  EXPECT_TRUE(known_in(0, 1, grid->width)) << "lowest row";
  EXPECT_TRUE(known_in((grid->height - 1) * grid->width, 1, grid->width)) << "highest row";
  EXPECT_TRUE(known_in(0, grid->width, grid->height)) << "leftmost column";
  EXPECT_TRUE(known_in(grid->width - 1, grid->width, grid->height)) << "rightmost column";
}

TEST(OccupancyGrid, ALargeMapIsSentWithLargerCellsAndKeepsItsWalls) {
  GridMap map;
  map.frame.resolution_m = 0.05;
  for (int x = -1500; x < 1500; ++x) {  // 150 m of two walls, 20 m apart
    for (const int y : {-200, 200}) {
      OccupancyCell& cell = map.occupancy.edit({x, y});
      cell.visits = cell.hits = 5;
    }
  }
  const auto grid = to_occupancy_grid(map, timestamp_from_us(1));
  ASSERT_TRUE(grid);
  EXPECT_LE(encode(channels::kSlamGrid, *grid).payload.size(), kMaxPayloadBytes);
  EXPECT_FLOAT_EQ(grid->meters_per_cell, 0.25F);  // 3000 x 401 cells / 65 000 = 4.3^2
  EXPECT_EQ(grid->width, 600);
  EXPECT_FLOAT_EQ(grid->origin_x, static_cast<float>(map.frame.origin_m.x() - 75.0));
  for (int x = 0; x < grid->width; ++x) {
    EXPECT_GT(grid->cells[static_cast<std::size_t>(x)], 0) << x;
    EXPECT_GT(grid->cells[static_cast<std::size_t>((grid->height - 1) * grid->width + x)], 0) << x;
  }
  EXPECT_FALSE(to_occupancy_grid(GridMap{}, timestamp_from_us(1)));
}

TEST(MbotSlam, AResetIsObeyedOnlyForTheCurrentModeWithoutRetainPose) {
  auto input = messages_of_drive(2.0);
  const auto middle = input.begin() + static_cast<std::ptrdiff_t>(input.size() / 2);
  const auto poses_with = [&](const std::vector<Message>& resets) {
    std::vector<Message> messages{input.begin(), middle};
    messages.insert(messages.end(), resets.begin(), resets.end());
    messages.insert(messages.end(), middle, input.end());
    std::vector<float> x;
    for (const Message& message : Slam{mbot_config()}.feed(messages)) {
      if (message.channel == "SLAM_POSE") x.push_back(decode<pose2D_t>(message.payload).message->x);
    }
    return x;
  };
  const auto usual = poses_with({});
  EXPECT_EQ(poses_with({reset_message(slam_status_t::MODE_LOCALISATION_ONLY, false),
                        reset_message(slam_status_t::MODE_FULL, true)}),
            usual);
  const auto anew = poses_with({reset_message(slam_status_t::MODE_FULL, false)});
  EXPECT_NEAR(usual.back(), 2.0, 0.1);
  EXPECT_NEAR(anew.back(), 1.0, 0.15);
}

TEST(MbotSlam, AResetClearsTheMapOfSubscribers) {
  auto input = messages_of_drive(1.0);
  Slam slam{mbot_config()};
  for (const Message& message : input)
    slam.inbox.deliver(message);
  slam.outbox.take();
  slam.inbox.deliver(reset_message(slam_status_t::MODE_FULL, false));
  int tiles = 0;
  for (const Message& message : slam.outbox.take()) {
    if (message.channel != "SLAM_MAP") continue;
    const auto decoded = decode<map_tiles_t>(message.payload);
    for (const map_tile_t& tile : decoded.message->tiles) {
      ++tiles;
      EXPECT_TRUE(std::ranges::all_of(tile.occupancy, [](int percent) { return percent == -1; }));
    }
  }
  EXPECT_GT(tiles, 2);
}

}  // namespace
}  // namespace waymark
