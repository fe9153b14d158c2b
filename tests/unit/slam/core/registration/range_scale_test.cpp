// SPDX-License-Identifier: BSD-3-Clause
// Scale errors of a LiDAR's ranges: their estimates, and which of them are accepted.
#include "slam/core/registration/range_scale.hpp"

#include "common/random/random.hpp"

#include <gtest/gtest.h>

namespace waymark {
namespace {

constexpr double kCellSpacing_m = 0.25;
constexpr double kRangeSigma_m = 0.01;
constexpr double kTooLong = 0.05;

const Eigen::Matrix3d kNearby = Eigen::Vector3d{0.05, 0.05, 0.02}.cwiseAbs2().asDiagonal();

/// The walls of a corridor of this width with its end, from the base.
Points corridor_end(const Se2& map_from_base, double width_m, std::uint64_t seed) {
  Random random{{seed}};
  Points points;
  const auto add = [&](double x, double y) {
    points.push_back(map_from_base.inverse() *
                     Eigen::Vector2d{x + random.normal(0.0, kRangeSigma_m),
                                     y + random.normal(0.0, kRangeSigma_m)});
  };
  for (double x = -3.0; x <= 3.0; x += 0.05) {
    add(x, -0.5 * width_m);
    add(x, 0.5 * width_m);
  }
  for (double y = -0.5 * width_m; y <= 0.5 * width_m; y += 0.05)
    add(3.0, y);
  return points;
}

Points scaled(Points points, double factor) {
  for (Eigen::Vector2d& point : points)
    point *= factor;
  return points;
}

bool is_accepted(RangeScaleMonitor& monitor, const Points& points, const Se2& map_from_base) {
  return monitor.try_accept(kTooLong, points, Eigen::Vector2d::Zero(), map_from_base, kNearby,
                            RangeNoise{kRangeSigma_m});
}

TEST(FitRangeScale, FindsTheScaleAtAnInexactPose) {
  NdtMap map{kCellSpacing_m};
  for (const Eigen::Vector2d& point : corridor_end({}, 2.0, 1))
    map.add(point, 0);
  const Se2 truth{0.03, -0.02, 0.01};
  const RangeScale scale =
      fit_range_scale(scaled(corridor_end(truth, 2.0, 2), 1.0 + kTooLong), Eigen::Vector2d::Zero(),
                      map, {}, kNearby, RangeNoise{kRangeSigma_m});
  EXPECT_NEAR(scale.error, kTooLong, 0.004);
  EXPECT_LT(scale.sigma, 0.004);
}

TEST(RangeScaleMonitor, AcceptsAnErrorThatBeganSinceTheLastScan) {
  RangeScaleMonitor monitor{kCellSpacing_m};
  monitor.note_unscaled(corridor_end({}, 2.0, 1), {});
  const Se2 ahead{0.1, 0.0, 0.0};
  EXPECT_TRUE(is_accepted(monitor, scaled(corridor_end(ahead, 2.0, 2), 1.0 + kTooLong), ahead));
}

/// The scan fits at another scale since the pose is in the wrong one of two corridors.
TEST(RangeScaleMonitor, RejectsAnErrorThatTheLastScanHadAsWell) {
  constexpr double kWidth_m = 2.0 * (1.0 + kTooLong);
  RangeScaleMonitor monitor{kCellSpacing_m};
  monitor.note_unscaled(corridor_end({}, kWidth_m, 1), {});
  const Se2 ahead{0.1, 0.0, 0.0};
  EXPECT_FALSE(is_accepted(monitor, corridor_end(ahead, kWidth_m, 2), ahead));
}

TEST(RangeScaleMonitor, AcceptsAnEqualErrorAgainWhereverTheRobotIs) {
  RangeScaleMonitor monitor{kCellSpacing_m};
  monitor.note_unscaled(corridor_end({}, 2.0, 1), {});
  const Points wrong = scaled(corridor_end({}, 2.0, 2), 1.0 + kTooLong);
  ASSERT_TRUE(is_accepted(monitor, wrong, {}));
  const Se2 far_away{40.0, 0.0, 0.0};
  EXPECT_TRUE(is_accepted(monitor, wrong, far_away));
  monitor.note_unscaled(corridor_end({}, 2.0, 3), {});
  EXPECT_FALSE(is_accepted(monitor, wrong, far_away));
}

TEST(RangeScaleMonitor, AcceptsNothingBeforeAScanHasFitted) {
  RangeScaleMonitor monitor{kCellSpacing_m};
  EXPECT_FALSE(is_accepted(monitor, scaled(corridor_end({}, 2.0, 1), 1.0 + kTooLong), {}));
}

}  // namespace
}  // namespace waymark
