// SPDX-License-Identifier: BSD-3-Clause
#include "viewer/scene_updater.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <functional>

namespace waymark::viewer {
namespace {

using ::testing::ElementsAre;
using ::testing::SizeIs;

marker_map_t markers_at(std::int64_t utime, int part, int num_parts, int id) {
  marker_map_t message{};
  message.utime = utime;
  message.part = part;
  message.num_parts = num_parts;
  message.num_landmarks = 1;
  message.landmarks.resize(1);
  message.landmarks[0] = marker_landmark_t{};
  message.landmarks[0].id = id;
  return message;
}

slam_estimate_t estimate_at(std::int64_t utime) {
  slam_estimate_t message{};
  message.has_pose = 1;
  message.utime = utime;
  return message;
}

TEST(SceneUpdater, ALongPathIsThinnedInItsPastAndDenseAtItsEnd) {
  Scene scene;
  Counters counters;
  SceneUpdater updater{scene, counters};
  constexpr auto kMost = SceneUpdater::kMaxPathPoses;
  pose2D_t pose{};
  for (std::size_t i = 0; i < 2 * kMost + 10; ++i) {
    pose.utime = static_cast<std::int64_t>(i + 1);
    updater.add_odometry(pose);
  }
  EXPECT_LE(scene.odometry.size(), kMost);
  EXPECT_EQ(scene.odometry.front().time, timestamp_from_us(1));
  EXPECT_EQ(scene.odometry.back().time, timestamp_from_us(2 * kMost + 10));
  const auto steps = [&](std::size_t i) {
    return std::chrono::microseconds{scene.odometry[i + 1].time - scene.odometry[i].time}.count();
  };
  EXPECT_EQ(steps(0), 8);
  EXPECT_EQ(steps(scene.odometry.size() - 2), 1);
  EXPECT_EQ(counters.get("ODOMETRY kept at half of the rate up to now"), 3);
}

TEST(SceneUpdater, MarkersAppearWhenAllPartsHaveArrived) {
  Scene scene;
  Counters counters;
  SceneUpdater updater{scene, counters};
  updater.add(markers_at(10, 1, 2, 5));
  EXPECT_THAT(scene.landmarks, SizeIs(0));
  updater.add(markers_at(10, 0, 2, 4));
  ASSERT_THAT(scene.landmarks, SizeIs(2));
  EXPECT_EQ(scene.landmarks[0].id, 4);
  updater.add(markers_at(20, 0, 2, 9));
  EXPECT_THAT(scene.landmarks, SizeIs(2)) << "half a map does not replace a whole one";
  updater.add(markers_at(15, 1, 2, 9));
  EXPECT_EQ(scene.landmarks[0].id, 4) << "parts of different times do not mix";
}

TEST(SceneUpdater, AnEstimateKeepsItsWeakAxisAndItsSource) {
  Scene scene;
  Counters counters;
  SceneUpdater updater{scene, counters};
  updater.add(estimate_at(1'000'000));
  slam_estimate_t message = estimate_at(2'000'000);
  message.weak_axis[1] = 1.0;
  message.weak_information = 50.0;
  message.weak_axis_source = slam_estimate_t::SOURCE_NOTHING;
  updater.add(message);
  message.utime += 1;
  message.weak_axis_source = 100;
  updater.add(message);
  ASSERT_THAT(scene.estimates, SizeIs(3));
  EXPECT_FALSE(scene.estimates[0].weak_axis);
  ASSERT_TRUE(scene.estimates[1].weak_axis);
  EXPECT_EQ(scene.estimates[1].weak_axis->direction, (Eigen::Vector3d{0, 1, 0}));
  EXPECT_EQ(scene.estimates[1].weak_axis->information, 50.0);
  EXPECT_EQ(scene.estimates[1].weak_axis->source, WeakAxisSource::kNothing);
  EXPECT_EQ(scene.estimates[2].weak_axis->source, WeakAxisSource::kUnknown);
}

std::vector<std::int64_t> seconds_of(const std::vector<EstimatedPose>& path) {
  std::vector<std::int64_t> seconds;
  for (const EstimatedPose& pose : path)
    seconds.push_back(to_us(pose.time) / 1'000'000);
  return seconds;
}

TEST(SceneUpdater, WhenTheClockIsSetBackThePathContinuesAndStaysInOrder) {
  Scene scene;
  Counters counters;
  SceneUpdater updater{scene, counters};
  for (std::int64_t second = 1000; second < 1100; ++second)
    updater.add(estimate_at(second * 1'000'000));
  for (std::int64_t second = 500; second < 530; ++second)
    updater.add(estimate_at(second * 1'000'000));
  ASSERT_THAT(scene.estimates, SizeIs(100 + 30 - 19));
  EXPECT_EQ(scene.estimates.back().time, timestamp_from_us(529'000'000));
  EXPECT_TRUE(std::ranges::is_sorted(scene.estimates, std::less<>{}, &EstimatedPose::time));
  EXPECT_EQ(counters.get("SLAM_ESTIMATE clock was set"), 1);
}

TEST(SceneUpdater, APoseWithAStampFarAheadIsLeftOut) {
  Scene scene;
  Counters counters;
  SceneUpdater updater{scene, counters};
  updater.add(estimate_at(1'000'000));
  updater.add(estimate_at(3'600'000'000));
  updater.add(estimate_at(2'000'000));
  EXPECT_THAT(seconds_of(scene.estimates), ElementsAre(1, 2));
}

// A stamp ahead by less than kLongestPause may be right; only later stamps show that it is wrong.
TEST(SceneUpdater, APoseSlightlyAheadIsRemovedOnceEnoughLaterStampsAreConsistent) {
  Scene scene;
  Counters counters;
  SceneUpdater updater{scene, counters};
  updater.add(estimate_at(1'000'000));
  updater.add(estimate_at(300'000'000));
  for (std::int64_t second = 2; second <= 22; ++second)
    updater.add(estimate_at(second * 1'000'000));
  EXPECT_THAT(seconds_of(scene.estimates), ElementsAre(1, 21, 22));
}

TEST(SceneUpdater, MarkersAreUpdatedAfterTheClockIsSetBack) {
  Scene scene;
  Counters counters;
  SceneUpdater updater{scene, counters};
  updater.add(markers_at(100'000'000, 0, 1, 4));
  updater.add(markers_at(99'000'000, 0, 1, 5));
  EXPECT_EQ(scene.landmarks[0].id, 4) << "late";
  updater.add(markers_at(10'000'000, 0, 1, 6));
  EXPECT_EQ(scene.landmarks[0].id, 6);
}

TEST(SceneUpdater, AScanWithLabelledBeamsIsNotReplacedByOneWithout) {
  Scene scene;
  Counters counters;
  SceneUpdater updater{scene, counters};
  annotated_scan_t scan{};
  scan.num_beams = 1;
  scan.ranges = {1.0F};
  scan.angles = {0.0F};
  scan.marker_ids = {0};
  scan.utime = 1;
  updater.add(scan);
  scan.marker_ids = {-1};
  scan.utime = 2;
  updater.add(scan);
  EXPECT_EQ(to_us(scene.scan->time), 1);
}

}  // namespace
}  // namespace waymark::viewer
