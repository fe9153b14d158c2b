// SPDX-License-Identifier: BSD-3-Clause
// The process without a network: messages in, messages out.
#include "common/messages/convert.hpp"
#include "common/random/random.hpp"
#include "slam/slam_messages.hpp"
#include "unit/slam/slam_run.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <map>

namespace waymark {
namespace {

TEST(SlamNode, PublishesAnEstimateForEveryScan) {
  Slam slam;
  const auto input = messages_of_drive();
  const auto output = slam.feed(input);
  auto counts = count_by_channel(output);
  const int scans = count_by_channel(input)["LIDAR"];
  EXPECT_EQ(counts["SLAM_POSE"], scans);
  EXPECT_EQ(counts["SLAM_ESTIMATE"], scans);
  EXPECT_EQ(counts["SLAM_SCAN"], scans);
  EXPECT_EQ(counts["SLAM_PARTICLES"], scans);
  EXPECT_GE(counts["SLAM_MAP"], 6);
  EXPECT_EQ(counts["SLAM_GRID"], 0);
  for (const Message& message : output)
    EXPECT_LE(message.payload.size(), kMaxPayloadBytes) << message.channel;
}

TEST(SlamNode, DoesNotSubscribeToTheTruePose) {
  Slam slam;
  for (const auto& subscription : slam.inbox.subscriptions())
    EXPECT_NE(subscription.channel, "TRUE_POSE");
}

// The result is the same to the byte, however messages are ordered within the delay for which slam
// waits.
TEST(SlamNode, TheResultDoesNotDependOnTheDelaysOfTheChannels) {
  const auto input = messages_of_drive();
  const auto expected = Slam{}.feed(input);
  for (std::uint64_t seed = 0; seed < 5; ++seed) {
    Random random{seed};
    // Each channel comes with a delay of its own that changes now and then, in order.
    std::vector<std::pair<double, Message>> arriving;
    std::map<std::string, double> last_arrival_s;
    for (const Message& message : input) {
      const double arrival_s = to_seconds(message.time) + random.uniform(0.0, 0.1);
      double& last_s = last_arrival_s[message.channel];
      last_s = std::max(last_s, arrival_s);
      arriving.emplace_back(last_s, message);
    }
    std::stable_sort(arriving.begin(), arriving.end(),
                     [](const auto& a, const auto& b) { return a.first < b.first; });
    std::vector<Message> shuffled;
    for (const auto& [arrival_s, message] : arriving)
      shuffled.push_back(message);
    EXPECT_TRUE(Slam{}.feed(shuffled) == expected) << seed;
  }
}

TEST(SlamNode, TheLastPublicationHasTheWholeMap) {
  Slam slam;
  const auto output = slam.feed(messages_of_drive());
  std::map<std::pair<int, int>, map_tile_t> from_changes;
  std::map<std::pair<int, int>, map_tile_t> at_end;
  std::int64_t last_utime = 0;
  for (const Message& message : output) {
    if (message.channel != "SLAM_MAP") continue;
    const auto tiles = *decode<map_tiles_t>(message.payload).message;
    last_utime = std::max(last_utime, tiles.utime);
    for (const map_tile_t& tile : tiles.tiles)
      from_changes[{tile.tile_x, tile.tile_y}] = tile;
  }
  for (const Message& message : output) {
    if (message.channel != "SLAM_MAP") continue;
    const auto tiles = *decode<map_tiles_t>(message.payload).message;
    if (tiles.utime != last_utime) continue;
    for (const map_tile_t& tile : tiles.tiles)
      at_end[{tile.tile_x, tile.tile_y}] = tile;
  }
  ASSERT_EQ(from_changes.size(), at_end.size());
  int occupied = 0;
  for (const auto& [index, tile] : at_end) {
    EXPECT_EQ(from_changes.at(index).occupancy, tile.occupancy);
    occupied += static_cast<int>(
        std::count_if(tile.occupancy.begin(), tile.occupancy.end(), [](int o) { return o > 50; }));
  }
  EXPECT_GT(occupied, 100);
}

std::vector<trajectory_t> trajectories_in(const std::vector<Message>& output) {
  std::vector<trajectory_t> trajectories;
  for (const Message& message : output) {
    if (message.channel == "SLAM_TRAJECTORY")
      trajectories.push_back(*decode<trajectory_t>(message.payload).message);
  }
  return trajectories;
}

TEST(SlamNode, GmappingSendsItsTrajectoryAtTheEndAndOdometrySendsNone) {
  SlamConfig config = small_config();
  config.slam.estimator = EstimatorName::kGmapping;
  const auto input = messages_of_drive();
  const auto trajectories = trajectories_in(Slam{config}.feed(input));
  ASSERT_EQ(trajectories.size(), 1U);
  EXPECT_EQ(trajectories[0].num_poses, count_by_channel(input)["LIDAR"]);
  EXPECT_EQ(trajectories[0].poses.back().utime, trajectories[0].utime);
  EXPECT_NEAR(static_cast<double>(trajectories[0].poses.back().x), 0.6, 0.05);
  config.slam.estimator = EstimatorName::kOdometry;
  EXPECT_TRUE(trajectories_in(Slam{config}.feed(input)).empty());
}

TEST(SlamMessages, ALongTrajectoryIsSplitIntoParts) {
  std::vector<TimedPose> way;
  for (int i = 0; i < 7000; ++i)
    way.push_back({timestamp_from_us(i), Se2{1.0 * i, 0.0, 0.0}});
  const auto parts = to_messages(way);
  ASSERT_EQ(parts.size(), 3U);
  int next = 0;
  for (const trajectory_t& part : parts) {
    EXPECT_LE(encode(channels::kSlamTrajectory, part).payload.size(), kMaxPayloadBytes);
    EXPECT_EQ(part.utime, 6999);
    for (const pose2D_t& pose : part.poses)
      EXPECT_EQ(pose.utime, next++);
  }
  EXPECT_EQ(next, 7000);
}

TEST(SlamNode, WithoutInputNothingIsPublished) {
  Slam slam;
  EXPECT_TRUE(slam.feed({}).empty());
}

TEST(SlamNode, BadScansAndTimesAreCountedAndSkipped) {
  auto input = messages_of_drive(0.2);
  const auto scan_message = [](std::int64_t utime, std::vector<float> ranges) {
    planar_lidar_t scan{};
    scan.utime = utime;
    scan.nranges = static_cast<std::int32_t>(ranges.size());
    scan.ranges = std::move(ranges);
    scan.radstep = 0.1F;
    return encode(channels::kLidar, scan);
  };
  const float inf = std::numeric_limits<float>::infinity();
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const std::int64_t late = to_us(input[input.size() / 2].time);
  const auto middle = input.begin() + static_cast<std::ptrdiff_t>(input.size() / 2);
  input.insert(middle, {scan_message(late + 1, {inf, nan, -1.0F, 0.0F}),
                        scan_message(late + 3, {1.0F, 1.0F, 1.0F}), scan_message(5, {1.0F}),
                        encode(channels::kOdometry, to_pose_message(timestamp_from_us(7), Se2{}))});
  Slam slam;
  const auto output = slam.feed(input);
  const Counters& counters = slam.inbox.counters();
  EXPECT_EQ(counters.get("scans without returns"), 1);
  EXPECT_GE(counters.get("scans out of order"), 1);
  EXPECT_EQ(counters.get("odometry out of order"), 1);
  EXPECT_GE(counters.get("scans with another number of beams than configured"), 2);
  EXPECT_GT(count_by_channel(output)["SLAM_POSE"], 5);
}

TEST(SlamNode, WithoutEstimatesOrAMapTheNodeReportsFailure) {
  const auto input = messages_of_drive(0.2);
  Slam slam;
  slam.feed(input);
  EXPECT_FALSE(slam.node.failed());
  for (const std::string missing : {"ODOMETRY", "LIDAR"}) {
    auto rest = input;
    std::erase_if(rest, [&](const Message& message) { return message.channel == missing; });
    Slam without;
    without.feed(rest);
    EXPECT_TRUE(without.node.failed()) << missing;
  }
  SlamConfig millimetres = small_config();
  millimetres.robot.lidar.range_max_m = 0.2;
  Slam blind{millimetres};
  blind.feed(input);
  EXPECT_TRUE(blind.node.failed());
}

TEST(SlamNode, AScanOfTooManyBeamsForSlamScanIsThinnedInSlamScan) {
  auto input = messages_of_drive(0.2);
  planar_lidar_t scan{};
  scan.utime = to_us(input[input.size() / 2].time) + 1;
  scan.nranges = 6000;
  scan.ranges.assign(6000, 1.0F);
  scan.radstep = static_cast<float>(radians(360.0) / 6000.0);
  input.insert(input.begin() + static_cast<std::ptrdiff_t>(input.size() / 2),
               encode(channels::kLidar, scan));
  Slam slam;
  int thinned = 0;
  for (const Message& message : slam.feed(input)) {
    EXPECT_LE(message.payload.size(), kMaxPayloadBytes) << message.channel;
    if (message.channel != "SLAM_SCAN") continue;
    const auto answer = decode<annotated_scan_t>(message.payload);
    ASSERT_TRUE(answer.message);
    thinned += answer.message->num_beams == 3000;
  }
  EXPECT_EQ(thinned, 1);
}

TEST(SlamNode, ScansWithoutOdometryAreNotUsed) {
  auto input = messages_of_drive(0.2);
  std::erase_if(input, [](const Message& message) { return message.channel == "ODOMETRY"; });
  Slam slam;
  EXPECT_TRUE(slam.feed(input).empty());
  EXPECT_GT(slam.inbox.counters().get("scans after the last odometry"), 5);
}

TEST(SlamNode, ScansDoNotWaitForeverForACamera) {
  auto input = messages_of_drive(0.4);
  std::erase_if(input, [](const Message& message) { return message.channel == "MARKERS"; });
  const int scans = count_by_channel(input)["LIDAR"];
  EXPECT_EQ(count_by_channel(Slam{}.feed(input))["SLAM_POSE"], scans);
}

TEST(SlamNode, WithBlankIdsNoMarkerIsInTheMap) {
  SlamConfig config = small_config();
  config.slam.blank_ids = true;
  const auto input = messages_of_drive();
  const auto any_marker = [](const std::vector<Message>& output) {
    return std::any_of(output.begin(), output.end(), [](const Message& message) {
      return message.channel == "SLAM_MARKERS" &&
             decode<marker_map_t>(message.payload).message->num_landmarks > 0;
    });
  };
  EXPECT_TRUE(any_marker(Slam{}.feed(input)));
  EXPECT_FALSE(any_marker(Slam{config}.feed(input)));
}

/// As a sender would encode it that checks nothing.
template <class Type>
Message unchecked(const std::string& channel, const Type& message) {
  std::vector<std::uint8_t> payload(static_cast<std::size_t>(message.getEncodedSize()));
  message.encode(payload.data(), 0, message.getEncodedSize());
  return {channel, timestamp_from_us(message.utime), payload};
}

TEST(SlamNode, AbsurdOdometryAndMarkersCauseNeitherACrashNorAJump) {
  auto input = messages_of_drive();
  for (const float absurd_m : {1e20F, 3e38F, 9e6F}) {
    pose2D_t pose{};
    const auto middle = input.begin() + static_cast<std::ptrdiff_t>(input.size() / 2);
    pose.utime = to_us(middle->time) + 1;
    pose.x = absurd_m;
    input.insert(middle, unchecked("ODOMETRY", pose));
  }
  marker_detections_t frame{};
  frame.utime = to_us(input[input.size() / 3].time) + 1;
  frame.num_detections = 2;
  for (int i = 0; i < frame.num_detections; ++i) {
    marker_detection_t& detection = frame.detections.emplace_back();
    detection.id = 3;
    detection.orientation[0] = detection.other_orientation[0] = 1.0;
  }
  frame.detections[0].position_m[0] = 9e6;
  marker_detection_t& indefinite = frame.detections[1];
  indefinite.position_m[0] = 1.0;
  indefinite.orientation[0] = indefinite.orientation[2] = std::sqrt(0.5);  // faces along x
  for (int i = 0; i < 6; ++i)
    indefinite.covariance[7 * i] = 1e-4;
  indefinite.covariance[5] = indefinite.covariance[30] = 1e3;  // x with yaw
  input.push_back(encode(channels::kMarkers, frame));
  ++frame.utime;
  frame.detections[0].position_m[0] = 1e300;
  input.push_back(unchecked("MARKERS", frame));
  std::sort(input.begin(), input.end(), comes_before);
  for (const auto estimator : {EstimatorName::kOdometry, EstimatorName::kWaymark}) {
    SlamConfig config = small_config();
    config.slam.estimator = estimator;
    Slam slam{config};
    const auto output = slam.feed(input);
    EXPECT_EQ(slam.inbox.counters().get("ODOMETRY rejected: out of bounds"), 2);
    EXPECT_EQ(slam.inbox.counters().get("MARKERS rejected: out of bounds"), 1);
    EXPECT_EQ(slam.inbox.counters().get("odometry jumps"), 2) << "there and back";
    EXPECT_EQ(slam.inbox.counters().get("markers not upright"), 2);
    std::optional<pose2D_t> last;
    for (const Message& message : output) {
      if (message.channel == "SLAM_POSE") last = decode<pose2D_t>(message.payload).message;
    }
    ASSERT_TRUE(last);
    EXPECT_LT(std::hypot(last->x, last->y), 1.0);
  }
}

}  // namespace
}  // namespace waymark
