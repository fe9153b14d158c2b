// SPDX-License-Identifier: BSD-3-Clause
// Motions that a robot cannot have made.
#include "slam/core/motion/speed_limits.hpp"

#include <gtest/gtest.h>

namespace waymark {
namespace {

constexpr double kStep_s = 0.2;

Motion step(double drive_m, double turn_rad = 0.0) {
  return {{drive_m, 0.0, turn_rad}, drive_m, turn_rad};
}

SpeedLimits after_a_drive(double speed_m_s) {
  SpeedLimits limits;
  for (int i = 0; i < 100; ++i)
    EXPECT_TRUE(limits.allow(step(speed_m_s * kStep_s), kStep_s));
  return limits;
}

TEST(SpeedLimits, AMetreInAFifthOfASecondIsRejectedForASlowRobot) {
  SpeedLimits limits = after_a_drive(0.4);
  EXPECT_FALSE(limits.allow(step(1.0), kStep_s));
  EXPECT_FALSE(limits.allow(step(0.08, 1.0), kStep_s));
  EXPECT_TRUE(limits.allow(step(0.1), kStep_s));
}

TEST(SpeedLimits, ARobotMayAccelerate) {
  SpeedLimits limits = after_a_drive(0.1);
  for (double speed_m_s = 0.1; speed_m_s < 2.0; speed_m_s += 0.02)
    EXPECT_TRUE(limits.allow(step(speed_m_s * kStep_s), kStep_s)) << speed_m_s;
}

TEST(SpeedLimits, ARobotMayAccelerateAfterAnHourOfCreeping) {
  SpeedLimits limits;
  for (int i = 0; i < 18'000; ++i)
    EXPECT_TRUE(limits.allow(step(0.1 * kStep_s), kStep_s));
  for (double speed_m_s = 0.1; speed_m_s < 1.5; speed_m_s += 0.5 * kStep_s)
    EXPECT_TRUE(limits.allow(step(speed_m_s * kStep_s), kStep_s)) << speed_m_s;
}

TEST(SpeedLimits, ABurstOfFastStepsDoesNotRaiseTheLimit) {
  SpeedLimits limits = after_a_drive(0.4);
  for (int burst = 0; burst < 3; ++burst) {
    for (int i = 0; i < 10; ++i)
      EXPECT_FALSE(limits.allow(step(0.8), kStep_s));
    EXPECT_TRUE(limits.allow(step(0.08), kStep_s));
  }
}

TEST(SpeedLimits, FastStepsThatPersistAreAccepted) {
  SpeedLimits limits = after_a_drive(0.2);
  int refused = 0;
  for (int i = 0; i < 100; ++i)
    refused += !limits.allow(step(0.6), kStep_s);
  EXPECT_LE(refused, 20);
}

TEST(SpeedLimits, TheStepAfterAGapMayIncludeTheGapsMotion) {
  SpeedLimits limits = after_a_drive(0.4);
  EXPECT_TRUE(limits.allow(step(0.1), 3.0));
  EXPECT_TRUE(limits.allow(step(1.0), kStep_s));
  EXPECT_FALSE(limits.allow(step(1.0), kStep_s));
}

TEST(SpeedLimits, StandingDoesNotLowerTheLimit) {
  SpeedLimits limits;
  for (int i = 0; i < 1000; ++i)
    EXPECT_TRUE(limits.allow(step(0.0), kStep_s));
  EXPECT_TRUE(limits.allow(step(1.0), kStep_s));
}

}  // namespace
}  // namespace waymark
