// SPDX-License-Identifier: BSD-3-Clause
#include "slam/core/odometry/unmeasured_motion.hpp"

#include <gtest/gtest.h>

#include <chrono>

namespace waymark {
namespace {

/// Five times a second.
class Robot {
 public:
  UnmeasuredMotion motion{};

  void observe(double distance_m, bool is_doubtful = false, bool caught_up = false,
               Duration clock_set = {}) {
    Observation observation;
    observation.clock_set = clock_set;
    observation.elapsed_s = 0.2;
    observation.motion = {{distance_m, 0.0, 0.0}, distance_m, 0.0};
    observation.odometry_jumped = is_doubtful;
    observation.odometry_caught_up = caught_up;
    motion.follow(observation);
  }

  void drive() {
    for (int i = 0; i < 50; ++i)
      observe(0.02);
  }

  void stand(int observations) {
    for (int i = 0; i < observations; ++i)
      observe(0.0);
  }
};

TEST(UnmeasuredMotion, OdometryAndClockThatBeginAnewLeaveTheLengthOfThePauseOpen) {
  Robot robot;
  robot.drive();
  robot.observe(8.0, true, false, std::chrono::seconds{-30});
  EXPECT_GT(robot.motion.unmeasured_m(), 0.5);  // 0.1 m/s for several seconds
  Robot continuing;
  continuing.drive();
  continuing.observe(0.02, false, false, std::chrono::seconds{-30});
  EXPECT_EQ(continuing.motion.unmeasured_m(), 0.0);
}

TEST(UnmeasuredMotion, IsZeroWhileOdometryMoves) {
  Robot robot;
  robot.drive();
  EXPECT_EQ(robot.motion.unmeasured_m(), 0.0);
  EXPECT_EQ(robot.motion.possibly_stuck_m(), 0.0);
}

TEST(UnmeasuredMotion, IsPossibleWhileOdometryStandsUntilTheMotionIsObserved) {
  Robot robot;
  robot.drive();
  robot.stand(50);
  EXPECT_EQ(robot.motion.unmeasured_m(), 0.0);
  EXPECT_GT(robot.motion.possibly_stuck_m(), 0.1);  // of the metre that it would have driven
  robot.motion.note_observed();
  EXPECT_EQ(robot.motion.possibly_stuck_m(), 0.0);
}

TEST(UnmeasuredMotion, StepsOfAFifthOfAMillimetreAreStandingAndOfTwoMillimetresAreNot) {
  Robot robot;
  robot.drive();
  robot.observe(0.0002);
  EXPECT_TRUE(robot.motion.is_standing());
  robot.observe(0.002);  // 1 cm a second
  EXPECT_FALSE(robot.motion.is_standing());
}

TEST(UnmeasuredMotion, IsBoundedForAParkedRobot) {
  Robot robot;
  robot.drive();
  robot.stand(50'000);
  EXPECT_LT(robot.motion.possibly_stuck_m(), 0.5);
}

TEST(UnmeasuredMotion, GrowsWhileOdometryIsStuck) {
  Robot robot;
  robot.drive();
  robot.stand(1);
  robot.motion.note_moved(0.02, 0.2);
  robot.motion.note_observed();
  EXPECT_TRUE(robot.motion.is_unreliable());
  robot.stand(50);
  EXPECT_NEAR(robot.motion.unmeasured_m(), 1.0, 0.1);
  robot.observe(0.02);
  EXPECT_FALSE(robot.motion.is_unreliable());
  EXPECT_NEAR(robot.motion.take_unmeasured_m(), 1.0, 0.15);  // the motion was not observed
  EXPECT_EQ(robot.motion.unmeasured_m(), 0.0);
}

TEST(UnmeasuredMotion, AfterARobotReturnsItsOdometryIsNotTakenForStuck) {
  Robot robot;
  robot.drive();
  robot.stand(1);
  robot.motion.note_moved(0.09, 0.4);
  robot.stand(5);
  EXPECT_TRUE(robot.motion.is_unreliable());
  EXPECT_GT(robot.motion.unmeasured_m(), 0.0);
  robot.motion.note_returned();
  robot.stand(5);
  EXPECT_FALSE(robot.motion.is_unreliable());
  EXPECT_EQ(robot.motion.unmeasured_m(), 0.0);
}

TEST(UnmeasuredMotion, UsesTheEstimatedSpeedIfOdometryHasNeverMoved) {
  Robot robot;
  robot.stand(10);
  robot.motion.note_moved(0.1, 0.2);
  robot.motion.note_observed();
  robot.stand(10);
  EXPECT_TRUE(robot.motion.is_unreliable());
  EXPECT_NEAR(robot.motion.unmeasured_m(), 1.0, 0.11);  // 0.5 m/s for 2 s
}

TEST(UnmeasuredMotion, IsZeroAfterOdometryHasCaughtUp) {
  Robot robot;
  robot.drive();
  robot.stand(1);
  robot.motion.note_moved(0.02, 0.2);
  robot.stand(50);
  robot.observe(1.0, false, true);
  EXPECT_EQ(robot.motion.unmeasured_m(), 0.0);
  EXPECT_FALSE(robot.motion.is_unreliable());
}

TEST(UnmeasuredMotion, GrowsWhileOdometryJumps) {
  Robot robot;
  robot.drive();
  for (int i = 0; i < 5; ++i)
    robot.observe(0.0, true);
  EXPECT_TRUE(robot.motion.is_unreliable());
  EXPECT_NEAR(robot.motion.unmeasured_m(), 0.1, 0.02);
}

}  // namespace
}  // namespace waymark
