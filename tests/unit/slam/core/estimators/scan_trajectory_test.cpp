// SPDX-License-Identifier: BSD-3-Clause
#include "slam/core/estimators/scan_trajectory.hpp"

#include <gtest/gtest.h>

#include <numbers>

namespace waymark {
namespace {

Timestamp at(int second) {
  return Timestamp{duration_from_seconds(second)};
}

Motion step(double x_m, double theta_rad = 0.0) {
  return Motion::between(Se2{}, Se2{x_m, 0.0, theta_rad});
}

void expect_pose(const TimedPose& pose, int second, const Se2& expected) {
  EXPECT_EQ(pose.time, at(second));
  EXPECT_NEAR(pose.map_from_base.x(), expected.x(), 1e-12);
  EXPECT_NEAR(pose.map_from_base.y(), expected.y(), 1e-12);
  EXPECT_NEAR(angle_difference(pose.map_from_base.theta(), expected.theta()), 0.0, 1e-12);
}

TEST(ScanTrajectory, IsEmptyWithoutScans) {
  EXPECT_TRUE(ScanTrajectory{}.along({}).empty());
}

TEST(ScanTrajectory, FollowsOdometryAfterTheLastUpdate) {
  ScanTrajectory trajectory;
  trajectory.add(at(0), {}, true);
  trajectory.add(at(1), step(1.0, std::numbers::pi / 2), false);
  trajectory.add(at(2), step(2.0), false);
  const std::vector<Se2> updates{Se2{5.0, 0.0, 0.0}};
  const auto poses = trajectory.along(updates);
  ASSERT_EQ(poses.size(), 3U);
  expect_pose(poses[0], 0, {5.0, 0.0, 0.0});
  expect_pose(poses[1], 1, {6.0, 0.0, std::numbers::pi / 2});
  expect_pose(poses[2], 2, {6.0, 2.0, std::numbers::pi / 2});
}

TEST(ScanTrajectory, PassesThroughTheUpdatesAndSpreadsTheCorrectionOverTheSteps) {
  ScanTrajectory trajectory;
  trajectory.add(at(0), {}, true);
  trajectory.add(at(1), step(1.0), false);
  trajectory.add(at(2), {}, false);  // stands still: no share of the correction
  trajectory.add(at(3), step(3.0), true);
  trajectory.add(at(4), step(1.0), true);
  const std::vector<Se2> updates{Se2{}, Se2{4.4, 0.8, 0.0}, Se2{9.0, 9.0, 1.0}};
  const auto poses = trajectory.along(updates);
  ASSERT_EQ(poses.size(), 5U);
  expect_pose(poses[1], 1, {1.1, 0.2, 0.0});
  expect_pose(poses[2], 2, {1.1, 0.2, 0.0});
  expect_pose(poses[3], 3, updates[1]);
  expect_pose(poses[4], 4, updates[2]);
}

TEST(ScanTrajectory, TheCorrectionIsSpreadInProportionToTurnsToo) {
  ScanTrajectory trajectory;
  trajectory.add(at(0), {}, true);
  trajectory.add(at(1), step(0.0, 0.25), false);
  trajectory.add(at(2), step(0.0, 0.75), true);
  const std::vector<Se2> updates{Se2{}, Se2{0.0, 0.0, 1.2}};
  expect_pose(trajectory.along(updates)[1], 1, {0.0, 0.0, 0.30});
}

}  // namespace
}  // namespace waymark
