// SPDX-License-Identifier: BSD-3-Clause
#include "import/mbot/wheel_odometry.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace waymark {
namespace {

constexpr double kExact = 1e-12;
constexpr WheelGeometry kMillimetreTicks{0.001, 0.1};

EncoderTicks reading(double time_s, int left, int right) {
  return {timestamp_from_us(static_cast<std::int64_t>(time_s * 1e6)), 42, left, right};
}

TEST(WheelOdometry, EqualTicksDriveStraight) {
  ImportReport report{"log", AddressUnit::kByte};
  const std::vector ticks{reading(0, 1000, 500), reading(1, 1200, 700)};

  const auto poses = wheel_odometry(ticks, kMillimetreTicks, report);

  ASSERT_EQ(poses.size(), 2U);
  EXPECT_EQ(poses[0].pose.x(), 0.0);
  EXPECT_NEAR(poses[1].pose.x(), 0.2, kExact);
  EXPECT_EQ(poses[1].pose.theta(), 0.0);
}

TEST(WheelOdometry, RightWheelAloneTurnsLeft) {
  ImportReport report{"log", AddressUnit::kByte};
  const std::vector ticks{reading(0, 0, 0), reading(1, 0, 100)};

  const auto poses = wheel_odometry(ticks, kMillimetreTicks, report);

  // 0.1 m on the right, 0.1 m between the wheels: 1 rad, the centre goes 0.05 m at 0.5 rad.
  EXPECT_NEAR(poses[1].pose.theta(), 1.0, kExact);
  EXPECT_NEAR(poses[1].pose.x(), 0.05 * std::cos(0.5), kExact);
  EXPECT_NEAR(poses[1].pose.y(), 0.05 * std::sin(0.5), kExact);
}

TEST(WheelOdometry, CountersMayWrapAround) {
  ImportReport report{"log", AddressUnit::kByte};
  constexpr int kMost = std::numeric_limits<int>::max();
  constexpr int kLeast = std::numeric_limits<int>::min();
  const std::vector ticks{reading(0, kMost - 9, kMost - 9), reading(1, kLeast + 10, kLeast + 10)};

  const auto poses = wheel_odometry(ticks, kMillimetreTicks, report);

  EXPECT_NEAR(poses[1].pose.x(), 0.02, kExact);
  EXPECT_EQ(report.num_skipped(), 0);
}

TEST(WheelOdometry, ACounterResetIsReportedAndIsNoMotion) {
  ImportReport report{"log", AddressUnit::kByte};
  const std::vector ticks{reading(0, 90000, 90000), reading(0.1, 90100, 90100), reading(0.2, 0, 0),
                          reading(0.3, 100, 100)};

  const auto poses = wheel_odometry(ticks, kMillimetreTicks, report);

  EXPECT_NEAR(poses[3].pose.x(), 0.2, kExact);
  ASSERT_EQ(report.num_skipped(), 1);
  EXPECT_EQ(report.messages()[0],
            "log: byte 42: skipped: wheel jump: 90.100 m in 0.100000 s; the step is left out");
}

}  // namespace
}  // namespace waymark
