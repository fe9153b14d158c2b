// SPDX-License-Identifier: BSD-3-Clause
// Maps that outlive the run: files, and runs that begin with one.
#include "slam/map_file.hpp"

#include "common/files/whole_file.hpp"
#include "common/messages/convert.hpp"
#include "common/random/random.hpp"
#include "slam/core/graph/map_merge.hpp"
#include "slam/slam_node.hpp"
#include "support/synthetic_corridor.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <optional>

namespace waymark {
namespace {

namespace fs = std::filesystem;

test::SyntheticCorridor corridor_of(std::uint64_t seed) {
  test::SyntheticCorridor corridor;
  corridor.length_m = 14.0;
  corridor.drive_m = 12.0;
  corridor.speed_m_s = 0.3;
  corridor.seed = seed;
  corridor.markers = test::opposite_markers(corridor, 3.5, 3.0);
  return corridor;
}

std::vector<Message> messages_of(const test::SensorLog& log, double from_s = 0.0,
                                 double to_s = 1e6) {
  std::vector<Message> messages;
  for (const LidarScan& scan : log.scans)
    messages.push_back(encode(channels::kLidar, to_planar_lidar(scan)));
  for (const OdometrySample& sample : log.odometry) {
    messages.push_back(
        encode(channels::kOdometry, to_pose_message(sample.time, sample.odom_from_base)));
  }
  for (const MarkerDetections& frame : log.frames)
    messages.push_back(encode(channels::kMarkers, to_detections_message(frame)));
  std::erase_if(messages, [&](const Message& message) {
    const double time_s = 1e-6 * static_cast<double>(to_us(message.time));
    return time_s < from_s || time_s > to_s;
  });
  std::sort(messages.begin(), messages.end(), comes_before);
  return messages;
}

struct Drive {
  std::vector<slam_estimate_t> estimates{};
  std::vector<marker_landmark_t> markers{};  ///< at the end
  bool failed{false};
};

Drive drive_through(const SlamConfig& config, const std::vector<Message>& messages) {
  Inbox inbox;
  Outbox outbox;
  SlamNode node{config, inbox, outbox};
  for (const Message& message : messages)
    inbox.deliver(message);
  node.finish();
  Drive result;
  result.failed = node.failed();
  for (const Message& message : outbox.take()) {
    if (message.channel == channels::kSlamEstimate.name)
      result.estimates.push_back(*decode<slam_estimate_t>(message.payload).message);
    if (message.channel == channels::kSlamMarkers.name)
      result.markers = decode<marker_map_t>(message.payload).message->landmarks;
  }
  return result;
}

SlamConfig config_for(MapMode mode, const fs::path& map, StartKind start = StartKind::kAnywhere) {
  SlamConfig config;
  config.slam.mode = mode;
  if (mode != MapMode::kMap) {
    config.load_map = map;
    config.slam.start.kind = start;
  } else {
    config.save_map = map;
  }
  return config;
}

/// The first true pose of a drive is the origin of its map.
Se2 map_from_world(const test::SensorLog& log) {
  return log.truth.front().world_from_base.inverse();
}

Se2 true_pose(const test::SensorLog& log, std::int64_t utime) {
  const auto at =
      std::lower_bound(log.truth.begin(), log.truth.end(), timestamp_from_us(utime),
                       [](const test::TruePose& pose, Timestamp time) { return pose.time < time; });
  return at == log.truth.end() ? log.truth.back().world_from_base : at->world_from_base;
}

/// Largest distance of the estimates with a pose from the truth, in the map's frame.
double worst_error_m(const Drive& run, const test::SensorLog& log, const Se2& map_from_world,
                     std::size_t skipped = 0) {
  double worst_m = 0.0;
  for (const slam_estimate_t& estimate : run.estimates) {
    if (estimate.has_pose == 0) continue;
    if (skipped > 0) {
      --skipped;
      continue;
    }
    const Eigen::Vector2d truth = (map_from_world * true_pose(log, estimate.utime)).translation();
    worst_m = std::max(worst_m, std::hypot(estimate.x_m - truth.x(), estimate.y_m - truth.y()));
  }
  return worst_m;
}

std::size_t with_pose(const Drive& run) {
  return static_cast<std::size_t>(
      std::count_if(run.estimates.begin(), run.estimates.end(),
                    [](const slam_estimate_t& estimate) { return estimate.has_pose != 0; }));
}

class SavedMap : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    drive_ = new test::SensorLog{test::drive(corridor_of(1))};
    file_ = new fs::path{fs::path{testing::TempDir()} /
                         ("saved_" + std::to_string(::getpid()) + ".map.lcm")};
    ASSERT_FALSE(drive_through(config_for(MapMode::kMap, *file_), messages_of(*drive_)).failed);
  }

  static void TearDownTestSuite() {
    fs::remove(*file_);
    delete file_;
    delete drive_;
  }

  static fs::path other_file(const std::string& name) {
    return fs::path{testing::TempDir()} / (name + std::to_string(::getpid()) + ".map.lcm");
  }

  inline static test::SensorLog* drive_{nullptr};
  inline static fs::path* file_{nullptr};
};

TEST_F(SavedMap, IsReadAsItWasWritten) {
  const MapFile map = read_map_file(*file_);
  EXPECT_EQ(map.map.landmarks.size(), corridor_of(1).markers.size());
  EXPECT_GT(map.map.graph.poses.size(), 50U);
  EXPECT_GE(map.map.graph.edges.size(), map.map.graph.poses.size() - 1);
  const fs::path copy = other_file("copy");
  EXPECT_EQ(write_map_file(copy, map.map, map.info), map.map.map_id);
  EXPECT_EQ(read_whole_file(copy), read_whole_file(*file_));
  fs::remove(copy);
}

TEST_F(SavedMap, ThatIsDamagedAnywhereIsRefusedOrTheSame) {
  const std::string whole = read_whole_file(*file_);
  const std::int64_t map_id = read_map_file(*file_).map.map_id;
  const fs::path damaged = other_file("damaged");
  Random random{7};
  int refused = 0;
  for (int i = 0; i < 150; ++i) {
    const auto place =
        static_cast<std::size_t>(random.uniform(0.0, 1.0) * static_cast<double>(whole.size() - 1));
    for (const bool is_cut : {true, false}) {
      std::string bytes = whole;
      if (is_cut)
        bytes.resize(place);
      else
        bytes[place] = static_cast<char>(bytes[place] ^ 0x10);
      write_whole_file(damaged, bytes);
      try {
        EXPECT_EQ(read_map_file(damaged).map.map_id, map_id);
        EXPECT_FALSE(is_cut) << "at " << place;
      } catch (const SetupError& error) {
        ++refused;
        EXPECT_NE(std::string{error.what()}.find(damaged.string()), std::string::npos);
      }
    }
  }
  EXPECT_GT(refused, 280);  // a log's event numbers are not the map's content
  fs::remove(damaged);
}

TEST_F(SavedMap, IsWhereAnotherDayIsLocalised) {
  const test::SensorLog today = test::drive(corridor_of(2));
  const std::string before = read_whole_file(*file_);
  const Drive localised = drive_through(config_for(MapMode::kLocalise, *file_), messages_of(today));
  EXPECT_GT(with_pose(localised), localised.estimates.size() * 9 / 10);
  EXPECT_LT(worst_error_m(localised, today, map_from_world(*drive_)), 0.06);
  EXPECT_EQ(read_whole_file(*file_), before);
  const MapFile map = read_map_file(*file_);
  ASSERT_EQ(localised.markers.size(), map.map.landmarks.size());
  for (std::size_t i = 0; i < localised.markers.size(); ++i)
    EXPECT_EQ(localised.markers[i].x_m, map.map.landmarks[i].map_from_marker.x());
  for (const slam_estimate_t& estimate : localised.estimates)
    EXPECT_EQ(estimate.map_id, map.map.map_id);
}

TEST_F(SavedMap, GivesNoPoseBeforeAMarkerIsSeen) {
  test::SensorLog blind = test::drive(corridor_of(3));
  for (MarkerDetections& frame : blind.frames)
    frame.detections.clear();
  const Drive lost = drive_through(config_for(MapMode::kLocalise, *file_), messages_of(blind));
  EXPECT_EQ(with_pose(lost), 0U);
  EXPECT_TRUE(lost.failed);
  for (const slam_estimate_t& estimate : lost.estimates)
    EXPECT_EQ(estimate.health, slam_estimate_t::HEALTH_INITIALISING);
}

// Twins: nothing but the corridor's ends tells where the robot is.
TEST_F(SavedMap, OfTwinsGivesNoPoseThatIsWrong) {
  test::SyntheticCorridor twins = corridor_of(4);
  for (test::SyntheticMarker& marker : twins.markers)
    marker.id = 5;
  const test::SensorLog mapping = test::drive(twins);
  const fs::path map = other_file("twins");
  ASSERT_FALSE(drive_through(config_for(MapMode::kMap, map), messages_of(mapping)).failed);
  twins.seed = 5;
  const test::SensorLog today = test::drive(twins);
  for (const double from_s : {0.0, 8.0, 16.0}) {
    const Drive found =
        drive_through(config_for(MapMode::kLocalise, map), messages_of(today, from_s));
    EXPECT_LT(worst_error_m(found, today, map_from_world(mapping)), 0.3) << "from " << from_s;
  }
  fs::remove(map);
}

TEST_F(SavedMap, IsExtendedInItsFrame) {
  const fs::path half = other_file("half");
  const fs::path whole = other_file("whole");
  const test::SensorLog today = test::drive(corridor_of(6));
  ASSERT_FALSE(
      drive_through(config_for(MapMode::kMap, half), messages_of(today, 0.0, 20.0)).failed);
  SlamConfig config = config_for(MapMode::kExtend, half);
  config.save_map = whole;
  const Drive rest = drive_through(config, messages_of(today, 15.0));
  EXPECT_LT(worst_error_m(rest, today, map_from_world(today)), 0.06);
  const MapFile first = read_map_file(half);
  const MapFile both = read_map_file(whole);
  EXPECT_EQ(both.map.parent_map_id, first.map.map_id);
  EXPECT_LT(first.map.landmarks.size(), both.map.landmarks.size());
  EXPECT_EQ(both.map.landmarks.size(), corridor_of(6).markers.size());
  for (const Landmark& landmark : both.map.landmarks) {
    const auto& markers = corridor_of(6).markers;
    const auto& marker = markers[static_cast<std::size_t>(landmark.id)];
    const Eigen::Vector2d truth = map_from_world(today) * marker.position_m;
    EXPECT_LT((landmark.map_from_marker.translation() - truth).norm(), 0.06) << landmark.id;
  }
  fs::remove(half);
  fs::remove(whole);
}

TEST_F(SavedMap, IsRefusedWhereItDoesNotSuit) {
  SlamConfig config = config_for(MapMode::kLocalise, *file_);
  config.robot.markers.size_m = 0.2;
  EXPECT_THROW(drive_through(config, {}), SetupError);
  config = config_for(MapMode::kLocalise, *file_);
  config.slam.grid.resolution_m = 0.1;
  EXPECT_THROW(drive_through(config, {}), SetupError);
  config = config_for(MapMode::kLocalise, *file_);
  config.slam.mode = MapMode::kMap;
  EXPECT_THROW(drive_through(config, {}), SetupError);
  config = config_for(MapMode::kLocalise, *file_);
  config.slam.estimator = EstimatorName::kGmapping;
  EXPECT_THROW(drive_through(config, {}), SetupError);
  EXPECT_THROW(drive_through(config_for(MapMode::kLocalise, other_file("nowhere")), {}),
               SetupError);
}

TEST_F(SavedMap, InAnotherFrameIsTheSamePlace) {
  const MapFile map = read_map_file(*file_);
  const Se2 new_from_old{3.0, -2.0, 0.7};
  const fs::path file = other_file("turned");
  write_map_file(file, transformed(map.map, new_from_old), map.info);
  const test::SensorLog today = test::drive(corridor_of(2));
  const Drive localised = drive_through(config_for(MapMode::kLocalise, file), messages_of(today));
  EXPECT_GT(with_pose(localised), localised.estimates.size() * 9 / 10);
  EXPECT_LT(worst_error_m(localised, today, new_from_old * map_from_world(*drive_)), 0.06);
  fs::remove(file);
}

TEST_F(SavedMap, AndOneThatOverlapsAreMergedIntoOne) {
  const fs::path left = other_file("left");
  const fs::path right = other_file("right");
  const test::SensorLog day1 = test::drive(corridor_of(8));
  const test::SensorLog day2 = test::drive(corridor_of(9));
  ASSERT_FALSE(drive_through(config_for(MapMode::kMap, left), messages_of(day1, 0.0, 24.0)).failed);
  ASSERT_FALSE(drive_through(config_for(MapMode::kMap, right), messages_of(day2, 12.0)).failed);
  const MapFile a = read_map_file(left);
  const MapFile b = read_map_file(right);
  const auto alignment = align_by_markers(a.map, b.map);
  ASSERT_TRUE(alignment);
  EXPECT_GE(alignment->shared_markers, 2U);
  const MapSnapshot both = merged(a.map, b.map, alignment->a_from_b);
  const std::vector<test::SyntheticMarker> markers = corridor_of(8).markers;
  EXPECT_EQ(both.landmarks.size(), markers.size());
  for (const Landmark& landmark : both.landmarks) {
    const auto& marker = markers.at(static_cast<std::size_t>(landmark.id));
    const Eigen::Vector2d truth = map_from_world(day1) * marker.position_m;
    EXPECT_LT((landmark.map_from_marker.translation() - truth).norm(), 0.08) << landmark.id;
  }
  fs::remove(left);
  fs::remove(right);
}

TEST(MapAlignment, NeedsTwoMarkersInCommon) {
  EXPECT_FALSE(align_by_markers(MapSnapshot{}, MapSnapshot{}));
}

}  // namespace
}  // namespace waymark
