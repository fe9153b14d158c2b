// SPDX-License-Identifier: BSD-3-Clause
#include "viewer/pacer.hpp"

#include <gtest/gtest.h>

namespace waymark::viewer {
namespace {

using namespace std::chrono_literals;
constexpr Pacer::Clock::time_point kStart{1000s};

TEST(Pacer, StartsAtOnce) {
  EXPECT_TRUE(Pacer{0.05}.may_start(kStart));
}

TEST(Pacer, ThePauseIsProportionalToTheTimeWorked) {
  Pacer pacer{0.25};
  pacer.record_work(kStart, kStart + 2s);
  EXPECT_FALSE(pacer.may_start(kStart + 7999ms));
  EXPECT_TRUE(pacer.may_start(kStart + 8s));

  pacer.record_work(kStart + 8s, kStart + 8s + 20ms);
  EXPECT_FALSE(pacer.may_start(kStart + 8s + 79ms));
  EXPECT_TRUE(pacer.may_start(kStart + 8s + 80ms));
}

TEST(Pacer, RepeatedWorkTakesNoMoreThanItsShareOfTheTime) {
  Pacer pacer{0.05};
  std::chrono::milliseconds worked{0};
  auto now = kStart;
  for (; now < kStart + 60s; now += 1ms) {
    if (!pacer.may_start(now)) continue;
    const auto cost = 30ms + worked / 20;  // grows with the map
    pacer.record_work(now, now + cost);
    worked += cost;
    now += cost;
  }
  EXPECT_LE(worked, 0.05 * (now - kStart) + 500ms) << "the last pause may still be open";
  EXPECT_GE(worked, 0.03 * (now - kStart));
}

TEST(Pacer, AShareOfOneMeansNoPause) {
  Pacer pacer{1.0};
  pacer.record_work(kStart, kStart + 2s);
  EXPECT_TRUE(pacer.may_start(kStart + 2s));
}

}  // namespace
}  // namespace waymark::viewer
