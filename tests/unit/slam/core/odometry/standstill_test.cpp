// SPDX-License-Identifier: BSD-3-Clause
#include "slam/core/odometry/standstill.hpp"

#include <gtest/gtest.h>

namespace waymark {
namespace {

const Se2 kHere{5.0, -1.0, 0.4};

Standstill standstill_here() {
  return {7, {}, kHere, 100.0};
}

TEST(Standstill, NoiseIsNoMotion) {
  Standstill standstill = standstill_here();
  EXPECT_FALSE(standstill.compare(kHere * Se2{0.02, 0.01, 0.04}, 101.0));
  EXPECT_FALSE(standstill.compare(kHere * Se2{-0.02, 0.0, -0.04}, 102.0));
}

TEST(Standstill, MotionIsMeasuredSinceItWasLastObserved) {
  Standstill standstill = standstill_here();
  EXPECT_FALSE(standstill.compare(kHere * Se2{0.02, 0.0, 0.0}, 101.0));
  const auto first = standstill.compare(kHere * Se2{0.2, 0.0, 0.0}, 102.0);
  ASSERT_TRUE(first);
  EXPECT_NEAR(first->distance_m, 0.2, 1e-9);
  EXPECT_NEAR(first->elapsed_s, 2.0, 1e-9);
  EXPECT_FALSE(first->has_returned);
  const auto second = standstill.compare(kHere * Se2{0.5, 0.0, 0.0}, 102.5);
  ASSERT_TRUE(second);
  EXPECT_NEAR(second->distance_m, 0.3, 1e-9);
  EXPECT_NEAR(second->elapsed_s, 0.5, 1e-9);
}

TEST(Standstill, ATurnIsMotion) {
  Standstill standstill = standstill_here();
  EXPECT_TRUE(standstill.compare(kHere * Se2{0.0, 0.0, 0.06}, 101.0));
}

TEST(Standstill, AScanThatWasMismatchedForAMomentIsNoMotion) {
  Standstill standstill = standstill_here();
  ASSERT_FALSE(standstill.compare(kHere * Se2{0.2, 0.0, 0.0}, 101.0)->has_returned);
  EXPECT_TRUE(standstill.compare(kHere * Se2{0.05, 0.0, 0.0}, 102.0)->has_returned);
}

TEST(Standstill, ARobotThatHasBeenFarAwayHasMoved) {
  Standstill standstill = standstill_here();
  ASSERT_FALSE(standstill.compare(kHere * Se2{0.5, 0.0, 0.0}, 101.0)->has_returned);
  EXPECT_FALSE(standstill.compare(kHere, 102.0)->has_returned);
}

}  // namespace
}  // namespace waymark
