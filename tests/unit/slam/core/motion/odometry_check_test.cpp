// SPDX-License-Identifier: BSD-3-Clause
// Steps of the odometry that are rejected.
#include "slam/core/motion/odometry_check.hpp"

#include <gtest/gtest.h>

namespace waymark {
namespace {

constexpr double kScan_s = 0.2;

Motion drive(double driven_m) {
  return {{driven_m, 0.0, 0.0}, driven_m, 0.0};
}

OdometryCheck after_a_drive() {
  OdometryCheck check;
  for (int i = 0; i < 100; ++i) {
    check.plausible(drive(0.08), kScan_s, false);
    check.note_estimated({0.08, 0.0, 0.02}, kScan_s);
  }
  return check;
}

TEST(OdometryCheck, PlausibleStepsAreUnchanged) {
  OdometryCheck check = after_a_drive();
  const Motion motion = check.plausible(drive(0.09), kScan_s, false);
  EXPECT_EQ(motion.start_from_end.x(), 0.09);
  EXPECT_EQ(motion.guessed_s, 0.0);
  EXPECT_FALSE(check.is_refused());
  EXPECT_EQ(check.steps_without_odometry().size(), 2U);
}

TEST(OdometryCheck, AJumpIsReplacedByTheLastEstimatedStep) {
  OdometryCheck check = after_a_drive();
  const Motion motion = check.plausible(drive(1.5), 0.5 * kScan_s, false);
  EXPECT_TRUE(check.is_refused());
  EXPECT_DOUBLE_EQ(motion.start_from_end.x(), 0.04);
  EXPECT_DOUBLE_EQ(motion.start_from_end.theta(), 0.01);
  EXPECT_EQ(motion.guessed_s, 0.5 * kScan_s);
}

TEST(OdometryCheck, ARejectedStepIsReplacedByTheLastVelocityForAtMostOneScan) {
  OdometryCheck check = after_a_drive();
  check.note_estimated({0.08, 0.02, -0.04}, kScan_s);
  const Se2 half = check.plausible(drive(1.5), 0.5 * kScan_s, false).start_from_end;
  EXPECT_DOUBLE_EQ(half.x(), 0.04);
  EXPECT_DOUBLE_EQ(half.y(), 0.01);
  EXPECT_DOUBLE_EQ(half.theta(), -0.02);
  const Se2 longer = check.plausible(drive(3.0), 2.0 * kScan_s, false).start_from_end;
  EXPECT_DOUBLE_EQ(longer.x(), 0.08);  // not extrapolated
  EXPECT_DOUBLE_EQ(longer.theta(), -0.04);
}

TEST(OdometryCheck, WithoutAnEstimatedSpeedTheRobotIsAssumedToStand) {
  OdometryCheck check = after_a_drive();
  check.note_estimated({0.08, 0.0, 0.0}, 0.0);
  const Motion motion = check.plausible(drive(1.5), kScan_s, false);
  EXPECT_TRUE(check.is_refused());
  EXPECT_EQ(motion.start_from_end.x(), 0.0);
  EXPECT_EQ(motion.guessed_s, kScan_s);
}

TEST(OdometryCheck, HypothesesAreStandingTheLastStepAndTheRejectedStep) {
  OdometryCheck check = after_a_drive();
  check.plausible(drive(1.5), kScan_s, false);
  const std::vector<Se2> guesses = check.steps_without_odometry();
  ASSERT_EQ(guesses.size(), 3U);
  EXPECT_EQ(guesses[0].x(), 0.0);
  EXPECT_EQ(guesses[1].x(), 0.08);
  EXPECT_EQ(guesses[2].x(), 1.5);
}

TEST(OdometryCheck, LateMotionIsNotRejected) {
  OdometryCheck check = after_a_drive();
  EXPECT_EQ(check.plausible(drive(1.5), kScan_s, true).start_from_end.x(), 1.5);
  EXPECT_FALSE(check.is_refused());
}

}  // namespace
}  // namespace waymark
