// SPDX-License-Identifier: BSD-3-Clause
#include "slam/core/estimators/scan_poses.hpp"

#include <gtest/gtest.h>

#include <numbers>

namespace waymark {
namespace {

Timestamp at_s(int seconds) {
  return Timestamp{} + std::chrono::seconds{seconds};
}

/// Scans of the seconds 0 to 4, all at keyframe 0, since odometry is stuck.
ScanPoses five_scans(bool is_middle_observed) {
  ScanPoses scans;
  for (int i = 0; i < 5; ++i) {
    const bool is_middle = i == 2;
    const Se2 off{is_middle && is_middle_observed ? 0.8 : 0.0, 0.0, 0.0};
    scans.add({at_s(i), 0, off, static_cast<double>(i), is_middle && is_middle_observed});
  }
  return scans;
}

TEST(ScanPoses, FollowTheirKeyframes) {
  ScanPoses scans;
  scans.add({at_s(0), 0, {}, 0.0, true});
  scans.add({at_s(1), 1, {0.5, 0.0, 0.0}, 1.0, true});
  const auto poses = scans.along({Se2{1.0, 2.0, 0.0}, Se2{3.0, 4.0, std::numbers::pi / 2.0}});
  ASSERT_EQ(poses.size(), 2U);
  EXPECT_EQ(poses[1].time, at_s(1));
  EXPECT_NEAR(poses[0].map_from_base.x(), 1.0, 1e-12);
  EXPECT_NEAR(poses[1].map_from_base.x(), 3.0, 1e-12);
  EXPECT_NEAR(poses[1].map_from_base.y(), 4.5, 1e-12);
}

TEST(ScanPoses, LateMotionIsSpreadOverTheTimeWithoutOdometry) {
  const PoseSequence keyframes{Se2{10.0, 0.0, 0.0}};
  ScanPoses scans = five_scans(false);
  scans.spread_motion({at_s(5), 0, {}, 0.0}, {at_s(5), 0, {1.0, 0.0, 0.0}, 5.0}, keyframes);
  const auto poses = scans.along(keyframes);
  for (std::size_t i = 0; i < poses.size(); ++i)
    EXPECT_NEAR(poses[i].map_from_base.x(), 10.0 + 0.2 * static_cast<double>(i), 1e-9) << i;
}

TEST(ScanPoses, AScanThatWasObservedKeepsItsPose) {
  const PoseSequence keyframes{Se2{10.0, 0.0, 0.0}};
  ScanPoses scans = five_scans(true);
  scans.spread_motion({at_s(5), 0, {}, 0.0}, {at_s(5), 0, {1.0, 0.0, 0.0}, 4.0}, keyframes);
  const auto poses = scans.along(keyframes);
  EXPECT_NEAR(poses[1].map_from_base.x(), 10.4, 1e-9);
  EXPECT_NEAR(poses[2].map_from_base.x(), 10.8, 1e-9);
  EXPECT_NEAR(poses[3].map_from_base.x(), 10.9, 1e-9);
}

TEST(ScanPoses, ScansBeforeTheStandstillStay) {
  const PoseSequence keyframes{Se2{10.0, 0.0, 0.0}};
  ScanPoses scans = five_scans(false);
  scans.spread_motion({at_s(5), 0, {}, 3.0}, {at_s(5), 0, {1.0, 0.0, 0.0}, 5.0}, keyframes);
  const auto poses = scans.along(keyframes);
  EXPECT_EQ(poses[3].map_from_base.x(), 10.0);
  EXPECT_NEAR(poses[4].map_from_base.x(), 10.5, 1e-9);
}

}  // namespace
}  // namespace waymark
