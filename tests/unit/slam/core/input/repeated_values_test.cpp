// SPDX-License-Identifier: BSD-3-Clause
// Unit tests of sensors that send the same again and again.
#include "input_values.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <vector>

namespace waymark {
namespace {

using test::frame_at;
using test::odometry_at;
using test::scan_at;

/// Skips of frames in the first second, all used for one scan.
std::vector<Skip> skips_of(const std::vector<MarkerDetections>& frames) {
  SensorSetup setup;
  setup.lidar.range_max_m = 5.0;
  SensorQueue queue{setup};
  for (const int now_ms : {0, 1000, 1100})
    queue.add(odometry_at(now_ms));
  for (const MarkerDetections& frame : frames)
    queue.add(frame);
  queue.add(scan_at(1000));
  queue.finish();
  EXPECT_TRUE(queue.next());
  std::vector<Skip> skips = queue.take_skips();
  std::erase(skips, Skip::kMarkerImplausible);
  return skips;
}

TEST(SensorQueue, AFrameThatRepeatsThePreviousOneIsSkipped) {
  EXPECT_EQ(skips_of({frame_at(0, {10.0, 20.0}), frame_at(100, {10.0, 20.0}),
                      frame_at(200, {10.0, 20.0})}),
            (std::vector<Skip>{Skip::kFrameRepeated, Skip::kFrameRepeated}));
}

TEST(SensorQueue, AFrameThatDiffersSlightlyIsUsed) {
  EXPECT_TRUE(skips_of({frame_at(0, {10.0}), frame_at(100, {10.0 + 1e-9}),
                        frame_at(200, {10.0, 20.0}), frame_at(300, {10.0})})
                  .empty());
}

TEST(SensorQueue, EmptyFramesMayFollowEachOther) {
  EXPECT_TRUE(skips_of({frame_at(0, {}), frame_at(100, {}), frame_at(200, {})}).empty());
}

/// Observations without beams, of scans with `ranges_m(ms)` five times a second; a metre in 10 s.
std::size_t num_blind(const std::function<double(int)>& range_m) {
  SensorQueue queue{SensorSetup{}};
  std::size_t blind = 0;
  for (int now_ms = 0; now_ms <= 4000; now_ms += 100) {
    LidarScan scan = scan_at(now_ms);
    scan.angles_rad.clear();
    for (int beam = 0; beam < 40; ++beam)
      scan.angles_rad.push_back(0.1 * beam);
    scan.ranges_m.assign(40, range_m(now_ms));
    if (now_ms % 200 == 0) queue.add(scan);
    queue.add(odometry_at(now_ms));
    while (const auto ready = queue.next())
      blind += ready->observation.beams.empty() ? 1 : 0;
  }
  const std::vector<Skip> skips = queue.take_skips();
  EXPECT_EQ(static_cast<std::size_t>(std::ranges::count(skips, Skip::kScanRepeated)), blind);
  return blind;
}

TEST(SensorQueue, AScanThatRepeatsOneFromAnotherPlaceHasNoBeams) {
  EXPECT_EQ(num_blind([](int now_ms) { return 2.0 + 1e-6 * now_ms; }), 0U);
  EXPECT_GT(num_blind([](int) { return 2.0; }), 10U);
  // 3 cm apart a robot may see the same.
  EXPECT_EQ(num_blind([](int now_ms) { return 2.0 + 1e-3 * (now_ms / 400); }), 0U);
}

}  // namespace
}  // namespace waymark
