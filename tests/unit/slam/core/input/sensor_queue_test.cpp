// SPDX-License-Identifier: BSD-3-Clause
// Unit tests of what the queue lets through.
#include "input_values.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <limits>

namespace waymark {
namespace {

using test::at_ms;
using test::frame_at;
using test::odometry_at;
using test::scan_at;

/// A metre in 10 s by odometry at 10 Hz, with the scans and frames that there are.
std::vector<SensorQueue::Ready> all_ready(SensorQueue& queue, int until_ms,
                                          const std::vector<int>& scans_ms,
                                          const std::vector<int>& frames_ms = {}) {
  std::vector<SensorQueue::Ready> all;
  for (int now_ms = 0; now_ms <= until_ms; now_ms += 100) {
    if (std::ranges::count(scans_ms, now_ms) > 0) queue.add(scan_at(now_ms));
    if (std::ranges::count(frames_ms, now_ms) > 0) queue.add(frame_at(now_ms, {}));
    queue.add(odometry_at(now_ms));
    while (auto ready = queue.next())
      all.push_back(std::move(*ready));
  }
  return all;
}

std::vector<int> times_ms(const std::vector<SensorQueue::Ready>& all) {
  std::vector<int> times;
  for (const SensorQueue::Ready& ready : all)
    times.push_back(static_cast<int>(to_us(ready.observation.time) / 1000));
  return times;
}

SensorSetup setup_without_waiting() {
  SensorSetup setup;
  setup.lidar.range_max_m = 5.0;
  setup.preprocessing.marker_wait_s = 0.0;
  return setup;
}

TEST(SensorQueue, WhileTheLidarIsSilentOdometryAndCameraContinue) {
  SensorQueue queue{setup_without_waiting()};
  const auto all = all_ready(queue, 2200, {0, 200, 2100}, {1000});
  EXPECT_EQ(times_ms(all), (std::vector<int>{0, 200, 400, 600, 800, 1000, 2100}))
      << "a second after them it is clear that no scan comes";
  double way_m = 0.0;
  for (const SensorQueue::Ready& ready : all) {
    const int ms = static_cast<int>(to_us(ready.observation.time) / 1000);
    const bool has_scan = ms <= 200 || ms == 2100;
    EXPECT_EQ(ready.scan.has_value(), has_scan) << ms;
    EXPECT_EQ(ready.observation.beams.empty(), !has_scan) << ms;
    EXPECT_EQ(ready.observation.camera_reported, ms == 1000) << ms;
    way_m += ready.observation.motion.distance_m;
  }
  EXPECT_NEAR(way_m, 0.21, 1e-9);
}

TEST(SensorQueue, ThereIsNoObservationBeforeTheFirstScan) {
  SensorQueue queue{setup_without_waiting()};
  EXPECT_TRUE(all_ready(queue, 5000, {}).empty());
}

TEST(SensorQueue, WithoutOdometryThereIsNoObservation) {
  SensorQueue queue{setup_without_waiting()};
  queue.add(scan_at(0));
  queue.add(odometry_at(0));
  ASSERT_TRUE(queue.next());
  queue.add(odometry_at(9000));
  queue.add(odometry_at(9100));
  EXPECT_FALSE(queue.next());
  queue.add(scan_at(9000));
  EXPECT_TRUE(queue.next());
}

TEST(SensorQueue, AScanThatComesTooLateIsRefused) {
  SensorQueue queue{setup_without_waiting()};
  EXPECT_EQ(times_ms(all_ready(queue, 2000, {0})).back(), 1000);
  queue.add(scan_at(900));
  EXPECT_EQ(queue.take_skips(), std::vector<Skip>{Skip::kScanOutOfOrder});
  queue.add(scan_at(1500));
  EXPECT_EQ(to_us(queue.next()->observation.time), 1'500'000);
}

double way_m(const std::vector<SensorQueue::Ready>& all) {
  double way = 0.0;
  for (const SensorQueue::Ready& ready : all)
    way += ready.observation.motion.distance_m;
  return way;
}

/// 20 s with odometry, scans and frames at 10 Hz; `stamp_ms` is the clock's reading at a time.
std::vector<SensorQueue::Ready> all_ready_by(SensorQueue& queue,
                                             const std::function<int(int)>& stamp_ms) {
  std::vector<SensorQueue::Ready> all;
  for (int now_ms = 0; now_ms <= 20'000; now_ms += 100) {
    queue.add({at_ms(stamp_ms(now_ms)), odometry_at(now_ms).odom_from_base});
    queue.add(scan_at(stamp_ms(now_ms)));
    queue.add(frame_at(stamp_ms(now_ms), {}));
    while (auto ready = queue.next())
      all.push_back(std::move(*ready));
  }
  return all;
}

constexpr int kHour_ms = 3'600'000;

TEST(SensorQueue, AClockStepLosesNoMotion) {
  for (const int step_ms : {-kHour_ms, -5000, kHour_ms}) {
    SensorQueue queue{setup_without_waiting()};
    const auto all = all_ready_by(queue, [step_ms](int now_ms) {
      return kHour_ms + now_ms + (now_ms < 10'000 ? 0 : step_ms);
    });
    EXPECT_GT(all.size(), 170U) << step_ms;
    EXPECT_NEAR(way_m(all), 2.0, 1e-9) << step_ms;
    double elapsed_s = 0.0;
    Duration clock_set{};
    for (const SensorQueue::Ready& ready : all) {
      elapsed_s += ready.observation.elapsed_s;
      clock_set += ready.observation.clock_set;
    }
    EXPECT_NEAR(to_seconds(clock_set), 1e-3 * step_ms, 0.2);
    EXPECT_NEAR(elapsed_s, 20.0, 1.0) << step_ms;
    const auto skips = queue.take_skips();
    EXPECT_EQ(std::ranges::count(skips, Skip::kClockSet), 1) << step_ms;
  }
}

TEST(SensorQueue, OnlyValuesWithAWrongStampAreDropped) {
  for (const int wrong_ms : {60'000, kHour_ms}) {
    SensorQueue queue{setup_without_waiting()};
    for (int now_ms = 0; now_ms < 1000; now_ms += 100)
      queue.add(odometry_at(now_ms));
    queue.add(scan_at(wrong_ms));
    queue.add(frame_at(wrong_ms, {}));
    queue.add(odometry_at(kHour_ms));
    EXPECT_EQ(queue.take_skips(),
              (std::vector<Skip>{Skip::kOdometryAhead, Skip::kScanAhead, Skip::kFrameAhead}));
    queue.add(scan_at(800));
    queue.add(frame_at(800, {}));
    queue.add(odometry_at(1000));
    const auto ready = queue.next();
    ASSERT_TRUE(ready);
    EXPECT_TRUE(ready->observation.camera_reported);
    EXPECT_TRUE(queue.take_skips().empty());
  }
}

/// One message of each of these sensors is stamped wrong.
struct WrongStamp {
  int at_ms{12'000};
  int by_ms{0};
  bool odometry{false};
  bool scan{false};
  bool frame{false};
};

struct Drive {
  std::vector<int> times_ms{};  ///< of observations
  double way_m{0.0};
  int camera_reports{0};
  int longest_wait_ms{0};  ///< from a scan's time until it was observed
  std::vector<Skip> skips{};
};

/// 25 s with odometry, scans and frames at 10 Hz.
Drive drive_with(const WrongStamp& wrong) {
  SensorSetup setup;
  setup.lidar.range_max_m = 5.0;
  SensorQueue queue{setup};
  Drive drive;
  for (int now_ms = 0; now_ms <= 25'000; now_ms += 100) {
    const auto stamp_ms = [&](bool is_wrong) {
      return now_ms + (is_wrong && now_ms == wrong.at_ms ? wrong.by_ms : 0);
    };
    queue.add({at_ms(stamp_ms(wrong.odometry)), odometry_at(now_ms).odom_from_base});
    queue.add(scan_at(stamp_ms(wrong.scan)));
    queue.add(frame_at(stamp_ms(wrong.frame), {}));
    while (const auto ready = queue.next()) {
      drive.times_ms.push_back(static_cast<int>(to_us(ready->observation.time) / 1000));
      drive.way_m += ready->observation.motion.distance_m;
      drive.camera_reports += ready->observation.camera_reported ? 1 : 0;
      drive.longest_wait_ms = std::max(drive.longest_wait_ms, now_ms - drive.times_ms.back());
    }
  }
  drive.skips = queue.take_skips();
  return drive;
}

std::vector<int> without(std::vector<int> times_ms, int time_ms) {
  std::erase(times_ms, time_ms);
  return times_ms;
}

constexpr int kAheadOrPast_ms[] = {-9950, -3000, -450, -250, 250, 300, 450, 3000, 9950};
constexpr int kSoon_ms = 300;

TEST(SensorQueue, AScanWithAWrongStampIsDroppedAlone) {
  const Drive clean = drive_with({});
  EXPECT_TRUE(clean.skips.empty());
  for (const int by_ms : kAheadOrPast_ms) {
    const Drive drive = drive_with({.by_ms = by_ms, .scan = true});
    EXPECT_EQ(drive.times_ms, without(clean.times_ms, 12'000)) << by_ms;
    EXPECT_NEAR(drive.way_m, clean.way_m, 1e-9) << by_ms;
    EXPECT_EQ(drive.skips, std::vector{by_ms > 0 ? Skip::kScanAhead : Skip::kScanOutOfOrder})
        << by_ms;
    EXPECT_LE(drive.longest_wait_ms, kSoon_ms) << by_ms;
  }
}

TEST(SensorQueue, AFrameWithAWrongStampIsDroppedAlone) {
  const Drive clean = drive_with({});
  for (const int by_ms : kAheadOrPast_ms) {
    const Drive drive = drive_with({.by_ms = by_ms, .frame = true});
    EXPECT_EQ(drive.times_ms, clean.times_ms) << by_ms;
    EXPECT_EQ(drive.skips, std::vector{by_ms > 0 ? Skip::kFrameAhead : Skip::kFrameOutOfOrder})
        << by_ms;
    // The frame after it waits for the next one, too, and is used with it.
    EXPECT_GE(drive.camera_reports, clean.camera_reports - 2) << by_ms;
    EXPECT_LE(drive.longest_wait_ms, kSoon_ms) << by_ms;
  }
}

TEST(SensorQueue, OdometryWithAWrongStampIsDroppedAlone) {
  const Drive clean = drive_with({});
  for (const int by_ms : kAheadOrPast_ms) {
    const Drive drive = drive_with({.by_ms = by_ms, .odometry = true});
    EXPECT_EQ(drive.times_ms, clean.times_ms) << by_ms;
    EXPECT_NEAR(drive.way_m, clean.way_m, 1e-9) << by_ms;
    EXPECT_EQ(drive.skips,
              std::vector{by_ms > 0 ? Skip::kOdometryAhead : Skip::kOdometryOutOfOrder})
        << by_ms;
    EXPECT_LE(drive.longest_wait_ms, kSoon_ms) << by_ms;
  }
}

TEST(SensorQueue, WrongStampsOfAllSensorsAtOnceDropOnlyThoseValues) {
  const Drive clean = drive_with({});
  for (const int by_ms : kAheadOrPast_ms) {
    const Drive drive = drive_with({.by_ms = by_ms, .odometry = true, .scan = true, .frame = true});
    EXPECT_EQ(drive.times_ms, without(clean.times_ms, 12'000)) << by_ms;
    EXPECT_NEAR(drive.way_m, clean.way_m, 1e-9) << by_ms;
    EXPECT_EQ(drive.skips.size(), 3U) << by_ms;
    EXPECT_LE(drive.longest_wait_ms, kSoon_ms) << by_ms;
  }
}

TEST(SensorQueue, AFirstValueStampedAheadDropsNoLaterValue) {
  const Drive clean = drive_with({});
  const auto from_second = without(clean.times_ms, 0);
  for (const int by_ms : {250, 3000, 9950}) {
    const WrongStamp at_start{.at_ms = 0, .by_ms = by_ms};
    WrongStamp scan = at_start;
    scan.scan = true;
    EXPECT_EQ(drive_with(scan).times_ms, from_second) << by_ms;
    WrongStamp frame = at_start;
    frame.frame = true;
    EXPECT_EQ(drive_with(frame).times_ms, clean.times_ms) << by_ms;
    WrongStamp odometry = at_start;
    odometry.odometry = true;
    EXPECT_EQ(drive_with(odometry).times_ms, from_second) << by_ms << ": nothing covers 0";
  }
}

TEST(SensorQueue, AScanStampedAheadBlocksNothingWhileTheLidarIsSilent) {
  SensorQueue queue{setup_without_waiting()};
  std::vector<SensorQueue::Ready> all = all_ready(queue, 200, {0, 200});
  queue.add(scan_at(9000));
  for (int now_ms = 300; now_ms <= 3000; now_ms += 100) {
    queue.add(odometry_at(now_ms));
    while (auto ready = queue.next())
      all.push_back(std::move(*ready));
  }
  EXPECT_EQ(times_ms(all).back(), 2000);
}

TEST(SensorQueue, AScanAtTheFirstOdometryAfterAPauseWaitsForTheNextSampleOrTheEnd) {
  for (const int pause_ms : {5000, 29'000}) {
    for (const bool ends : {false, true}) {
      SensorQueue queue{setup_without_waiting()};
      EXPECT_EQ(all_ready(queue, 1000, {0, 1000}).size(), 2U);
      queue.add(frame_at(1000 + pause_ms, {}));
      queue.add(scan_at(1000 + pause_ms));
      queue.add(odometry_at(1000 + pause_ms));
      EXPECT_FALSE(queue.next());
      if (ends) {
        queue.finish();
      } else {
        queue.add(odometry_at(1100 + pause_ms));
      }
      const auto ready = queue.next();
      ASSERT_TRUE(ready && ready->scan) << pause_ms;
      EXPECT_NEAR(ready->observation.motion.distance_m, 1e-4 * pause_ms, 1e-9);
      EXPECT_TRUE(ready->observation.camera_reported);
      EXPECT_TRUE(queue.take_skips().empty());
    }
  }
}

TEST(SensorQueue, AStampFarAheadOfTheFirstOdometryDoesNotBlock) {
  SensorQueue queue{setup_without_waiting()};
  queue.add(scan_at(kHour_ms));
  queue.add(frame_at(kHour_ms, {}));
  EXPECT_EQ(all_ready(queue, 1000, {200, 400}, {200}).size(), 2U);
  EXPECT_EQ(queue.take_skips(), (std::vector<Skip>{Skip::kScanAhead, Skip::kFrameAhead}));
}

TEST(SensorQueue, AFrameOlderThanTheOdometryBufferIsCounted) {
  SensorQueue queue{setup_without_waiting()};
  EXPECT_EQ(all_ready(queue, 1000, {200, 800}).size(), 2U);
  queue.add(frame_at(300, {}));
  queue.add(scan_at(1000));
  EXPECT_TRUE(queue.next());
  EXPECT_EQ(queue.take_skips(), std::vector<Skip>{Skip::kFrameWithoutOdometry});
}

TEST(SensorQueue, AScanWithoutReturnsIsCountedAndStillAnObservation) {
  SensorQueue queue{setup_without_waiting()};
  LidarScan nothing = scan_at(0);
  nothing.ranges_m.assign(3, std::numeric_limits<double>::infinity());
  queue.add(nothing);
  queue.add(odometry_at(0));
  const auto ready = queue.next();
  ASSERT_TRUE(ready);
  EXPECT_TRUE(ready->scan && ready->observation.beams.empty());
  EXPECT_EQ(queue.take_skips(), std::vector<Skip>{Skip::kScanWithoutReturns});
}

}  // namespace
}  // namespace waymark
