// SPDX-License-Identifier: BSD-3-Clause
#include "sim/core/sensors/lidar.hpp"

#include "sim/core/world/mjcf.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace waymark {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

Physics standing_at(const Se2& world_from_start) {
  MjcfOptions options{};
  options.world_from_start = world_from_start;
  return Physics{to_mjcf(build_world({}, {}, 0.6, 1), {}, options)};
}

/// Distance from inside the default corridor to its inner faces, computed by hand.
double expected_range_m(const Se2& world_from_lidar, double angle_rad) {
  const double direction = world_from_lidar.theta() + angle_rad;
  const double dx = std::cos(direction);
  const double dy = std::sin(direction);
  const double to_x = ((dx > 0 ? 50.0 : 0.0) - world_from_lidar.x()) / dx;
  const double to_y = ((dy > 0 ? 1.0 : -1.0) - world_from_lidar.y()) / dy;
  return std::min(std::abs(dx) < 1e-12 ? kInfinity : to_x, std::abs(dy) < 1e-12 ? kInfinity : to_y);
}

TEST(Lidar, SeesTheInnerFacesFromItsMounting) {
  const Se2 world_from_base{3.0, -0.2, 0.4};  // the start wall is in range, plates are beside
  const Physics physics = standing_at(world_from_base);
  const LidarConfig config{};
  Lidar lidar{config, {0.0, 0.0}, 1};

  const LidarScan scan = lidar.scan(timestamp_from_us(7), physics);

  ASSERT_EQ(scan.ranges_m.size(), 360U);
  EXPECT_EQ(scan.time, timestamp_from_us(7));
  const Se2 world_from_lidar = world_from_base * config.base_from_lidar();
  for (std::size_t i = 0; i < 360; ++i) {
    const double expected = expected_range_m(world_from_lidar, scan.angles_rad[i]);
    if (expected > config.range_max_m + 0.02) {
      EXPECT_EQ(scan.ranges_m[i], kInfinity) << i;
    } else if (expected < config.range_max_m - 0.02) {
      EXPECT_NEAR(scan.ranges_m[i], expected, 0.003) << i;  // the body tilts by 0.1 mrad or so
    }
  }
}

TEST(Lidar, AMirroredLidarCountsItsAnglesClockwise) {
  const Physics physics = standing_at({3.0, -0.2, 0.4});
  LidarConfig mirrored_config{};
  mirrored_config.mirrored = true;
  Lidar lidar{{}, {0.0, 0.0}, 1};
  Lidar mirrored{mirrored_config, {0.0, 0.0}, 1};
  const LidarScan scan = lidar.scan({}, physics);
  const LidarScan reversed = mirrored.scan({}, physics);
  ASSERT_EQ(reversed.ranges_m.size(), 360U);
  EXPECT_EQ(reversed.angles_rad, scan.angles_rad);
  for (std::size_t i = 1; i < 360; ++i) {
    if (std::isinf(scan.ranges_m[i])) continue;
    EXPECT_NEAR(reversed.ranges_m[360 - i], scan.ranges_m[i], 1e-9);
  }
}

TEST(Lidar, NoiseAndDropoutsAreAsConfigured) {
  const Physics physics = standing_at({10.0, 0.0, 0.0});
  Lidar clean{{}, {0.0, 0.0}, 1};
  Lidar noisy{{}, {0.02, 0.1}, 1};
  const LidarScan truth = clean.scan({}, physics);
  double sum2 = 0.0;
  int valid = 0, dropped = 0, seen = 0;
  for (int repetition = 0; repetition < 20; ++repetition) {
    const LidarScan scan = noisy.scan({}, physics);
    for (std::size_t i = 0; i < 360; ++i) {
      if (truth.ranges_m[i] > 3.0) continue;
      ++seen;
      if (std::isnan(scan.ranges_m[i])) {
        ++dropped;
      } else {
        sum2 += std::pow(scan.ranges_m[i] - truth.ranges_m[i], 2);
        ++valid;
      }
    }
  }
  EXPECT_NEAR(std::sqrt(sum2 / valid), 0.02, 0.001);  // about 5000 beams: sigma 1 %
  EXPECT_NEAR(static_cast<double>(dropped) / seen, 0.1, 0.02);
}

TEST(Lidar, RangesBelowTheMinimumAreNan) {
  const Physics physics = standing_at({10.0, 0.0, 0.0});
  LidarConfig config{};
  config.range_min_m = 1.1;
  config.range_max_m = 2.0;
  Lidar lidar{config, {0.0, 0.0}, 1};
  EXPECT_TRUE(std::isnan(lidar.scan({}, physics).ranges_m[90]));  // the wall at 1 m
}

TEST(Lidar, ASweepInPartsEqualsASweepAtOnceWhenTheRobotStands) {
  const Physics physics = standing_at({10.0, 0.0, 0.0});
  Lidar at_once{{}, {}, 3};
  Lidar in_parts{{}, {}, 3};
  LidarScan parts;
  for (const int count : {100, 1, 259})
    in_parts.add_beams(parts, count, physics);
  const LidarScan whole = at_once.scan({}, physics);
  ASSERT_EQ(parts.ranges_m.size(), whole.ranges_m.size());
  for (std::size_t i = 0; i < parts.ranges_m.size(); ++i) {
    if (std::isnan(whole.ranges_m[i])) continue;
    EXPECT_EQ(parts.ranges_m[i], whole.ranges_m[i]);
  }
}

}  // namespace
}  // namespace waymark
