// SPDX-License-Identifier: BSD-3-Clause
#include "sim/core/faults/corruption.hpp"
#include "sim/core/faults/faulty_outlet.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace waymark {
namespace {

using ::testing::AllOf;
using ::testing::Each;
using ::testing::ElementsAre;
using ::testing::Ge;
using ::testing::IsEmpty;
using ::testing::Le;

/// Measured once per second; the value is the time.
struct Reading {
  Timestamp time{};
  int value{0};
};

FaultConfig fault(FaultKind kind, Span during = {}) {
  FaultConfig config{};
  config.sensor = Sensor::kLidar;
  config.kind = kind;
  config.during = during;
  return config;
}

struct Sent {
  std::vector<double> stamps_s{};
  std::vector<int> values{};
};

/// Ten readings through the outlet, released once per second.
Sent send_ten(const FaultConfig& config) {
  FaultyOutlet<Reading> outlet{Faults{Sensor::kLidar, {config}}, 1};
  Sent sent;
  for (int i = 0; i < 12; ++i) {
    const double now_s = i;
    if (i < 10) outlet.push({timestamp_from_us(i * 1'000'000), i}, {now_s, 0.1 * now_s});
    for (const Reading& reading : outlet.release(timestamp_from_us((i + 1) * 1'000'000))) {
      EXPECT_GE(to_seconds(reading.time), now_s) << "sent after its tick";
      sent.stamps_s.push_back(to_seconds(reading.time));
      sent.values.push_back(reading.value);
    }
  }
  return sent;
}

TEST(Span, ASpanIsActiveWhereTimeAndDistanceAreBothWithinIt) {
  const Span span{.from_s = 1.0, .to_s = 2.0, .from_m = 5.0};
  EXPECT_TRUE(span.covers({1.0, 5.0}));
  EXPECT_FALSE(span.covers({2.0, 5.0}));
  EXPECT_FALSE(span.covers({1.0, 4.9}));
  EXPECT_TRUE(Span{}.is_always());
  EXPECT_FALSE(span.is_always());
}

TEST(FaultyOutlet, ADisabledSensorIsSilent) {
  EXPECT_THAT(send_ten(fault(FaultKind::kOff, {.from_s = 2.0, .to_s = 8.0})).values,
              ElementsAre(0, 1, 8, 9));
  EXPECT_THAT(send_ten(fault(FaultKind::kOff, {.from_m = 0.15})).values, ElementsAre(0, 1));
}

TEST(FaultyOutlet, FaultsOfAnotherSensorAreNotApplied) {
  FaultyOutlet<Reading> camera{Faults{Sensor::kCamera, {fault(FaultKind::kOff)}}, 1};
  camera.push({timestamp_from_us(0), 1}, {});
  EXPECT_EQ(camera.release(timestamp_from_us(1)).size(), 1U);
}

TEST(FaultyOutlet, AStuckSensorRepeatsItsLastValueWithNewStamps) {
  const Sent sent = send_ten(fault(FaultKind::kStuck, {.from_s = 3.0, .to_s = 6.0}));
  EXPECT_THAT(sent.values, ElementsAre(0, 1, 2, 2, 2, 2, 6, 7, 8, 9));
  EXPECT_THAT(sent.stamps_s, ElementsAre(0, 1, 2, 3, 4, 5, 6, 7, 8, 9));
}

TEST(FaultyOutlet, ASlowSensorKeepsEveryNthMessage) {
  FaultConfig config = fault(FaultKind::kSlow);
  config.keep_every = 4;
  EXPECT_THAT(send_ten(config).values, ElementsAre(0, 4, 8));
}

TEST(FaultyOutlet, ADelayedSensorIsStampedAndSentLate) {
  FaultConfig config = fault(FaultKind::kDelayed, {.from_s = 1.0, .to_s = 3.0});
  config.delay_s = 1.5;
  const Sent sent = send_ten(config);
  EXPECT_THAT(sent.stamps_s, ElementsAre(0, 2.5, 3, 3.5, 4, 5, 6, 7, 8, 9));
  EXPECT_THAT(sent.values, ElementsAre(0, 1, 3, 2, 4, 5, 6, 7, 8, 9));
}

TEST(FaultyOutlet, AnIntermittentSensorLosesTheConfiguredShareOfMessages) {
  FaultConfig config = fault(FaultKind::kIntermittent);
  config.share = 1.0;
  EXPECT_THAT(send_ten(config).values, IsEmpty());
  config.share = 0.3;
  FaultyOutlet<Reading> outlet{Faults{Sensor::kLidar, {config}}, 1};
  for (int i = 0; i < 1000; ++i)
    outlet.push({timestamp_from_us(i), i}, {});
  // The count is binomial, 1000 trials with probability 0.3: standard deviation 14.5.
  EXPECT_NEAR(static_cast<double>(outlet.release(timestamp_from_us(1000)).size()), 700.0, 58.0);
}

TEST(Corruption, ScaledRangesBeyondTheMaximumHaveNoReturn) {
  LidarScan scan{};
  scan.ranges_m = {1.0, 3.4, std::nan("")};
  scale_ranges(scan, {}, 0.05);
  EXPECT_DOUBLE_EQ(scan.ranges_m[0], 1.05);
  EXPECT_TRUE(std::isinf(scan.ranges_m[1]));
  EXPECT_TRUE(std::isnan(scan.ranges_m[2]));
}

TEST(Corruption, ScaledRangesBelowTheMinimumAreInvalid) {
  LidarScan scan{};
  scan.ranges_m = {1.0, 0.15};
  scale_ranges(scan, {}, -0.3);
  EXPECT_DOUBLE_EQ(scan.ranges_m[0], 0.7);
  EXPECT_TRUE(std::isnan(scan.ranges_m[1]));
}

TEST(Corruption, GarbageIsSpreadOverAllValuesThatTheSensorCouldSend) {
  LidarConfig lidar{};
  lidar.range_min_m = 1.0;
  lidar.range_max_m = 3.0;
  LidarScan scan{};
  scan.ranges_m.assign(2000, 2.0);
  Random random{1};
  make_garbage(scan, lidar, random);
  EXPECT_THAT(scan.ranges_m, Each(AllOf(Ge(1.0), Le(3.0))));
  EXPECT_LT(*std::ranges::min_element(scan.ranges_m), 1.05);
  EXPECT_GT(*std::ranges::max_element(scan.ranges_m), 2.95);

  for (int i = 0; i < 200; ++i) {
    OdometrySample sample{.odom_from_base = {5.0, -2.0, 1.0}};
    make_garbage(sample, random);
    EXPECT_NEAR(sample.odom_from_base.x(), 5.0, 1.0);
    EXPECT_NEAR(sample.odom_from_base.y(), -2.0, 1.0);
  }
}

TEST(Corruption, AWheelSlipIsLimitedInTimeAndStaysInTheOdometry) {
  FaultConfig config = fault(FaultKind::kWrong, {.from_s = 1.0, .to_s = 2.0});
  config.sensor = Sensor::kOdometry;
  config.share = 0.1;
  config.wheel = Wheel::kLeft;
  const Faults faults{Sensor::kOdometry, {config}};
  SpinningWheels wheels;
  WheelPair counted{};
  for (int i = 0; i <= 30; ++i) {
    const double time_s = 0.1 * i;
    counted = wheels.counted({2.0 * time_s, 3.0 * time_s}, faults, {time_s, 0.0});
  }
  EXPECT_NEAR(counted.left, 6.0 + 0.1 * 2.0, 0.021);  // give or take one period
  EXPECT_DOUBLE_EQ(counted.right, 9.0);
}

TEST(Corruption, TheWheelsOfAFaultSpinAndTheOtherDoesNot) {
  for (const Wheel wheel : {Wheel::kBoth, Wheel::kLeft, Wheel::kRight}) {
    FaultConfig config = fault(FaultKind::kWrong);
    config.sensor = Sensor::kOdometry;
    config.share = 0.5;
    config.wheel = wheel;
    SpinningWheels wheels;
    const WheelPair counted =
        wheels.counted({2.0, 4.0}, Faults{Sensor::kOdometry, {config}}, Moment{});
    EXPECT_DOUBLE_EQ(counted.left, wheel == Wheel::kRight ? 2.0 : 3.0);
    EXPECT_DOUBLE_EQ(counted.right, wheel == Wheel::kLeft ? 4.0 : 6.0);
  }
}

}  // namespace
}  // namespace waymark
