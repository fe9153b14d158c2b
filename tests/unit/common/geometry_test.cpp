// SPDX-License-Identifier: BSD-3-Clause
#include "common/geometry/principal_axes.hpp"
#include "common/geometry/rigid_fit.hpp"
#include "common/geometry/se2.hpp"
#include "common/node/counters.hpp"
#include "common/random/random.hpp"
#include "common/robot/robot_config.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

namespace waymark {
namespace {

constexpr double kPi = std::numbers::pi;

void expect_near(const Se2& a, const Se2& b) {
  EXPECT_NEAR(a.x(), b.x(), 1e-9);
  EXPECT_NEAR(a.y(), b.y(), 1e-9);
  EXPECT_NEAR(angle_difference(a.theta(), b.theta()), 0.0, 1e-12);
}

TEST(Angle, WrapsIntoTheHalfOpenInterval) {
  EXPECT_EQ(wrap_angle(kPi), kPi);
  EXPECT_EQ(wrap_angle(-kPi), kPi);
  EXPECT_NEAR(wrap_angle(3.0 * kPi + 0.1), -kPi + 0.1, 1e-12);
  EXPECT_NEAR(angle_difference(-3.0, 3.0), 2.0 * kPi - 6.0, 1e-12);
}

TEST(Angle, PiRadiansAre180Degrees) {
  EXPECT_NEAR(radians(180.0), kPi, 1e-15);
  EXPECT_NEAR(degrees(kPi), 180.0, 1e-12);
}

TEST(Se2, MovesPointsCounterClockwise) {
  const Se2 map_from_base{1.0, 2.0, kPi / 2.0};
  const Eigen::Vector2d point_in_map = map_from_base * Eigen::Vector2d{1.0, 0.0};
  EXPECT_NEAR(point_in_map.x(), 1.0, 1e-12);
  EXPECT_NEAR(point_in_map.y(), 3.0, 1e-12);
}

TEST(Se2, IsAGroup) {
  Random random{{3}};
  const auto draw = [&random] {
    return Se2{random.normal(0, 10), random.normal(0, 10), random.uniform(-9, 9)};
  };
  for (int i = 0; i < 200; ++i) {
    const Se2 a = draw();
    const Se2 b = draw();
    const Se2 c = draw();
    expect_near((a * b) * c, a * (b * c));
    expect_near(a * a.inverse(), Se2{});
    const Eigen::Vector2d point{random.normal(), random.normal()};
    EXPECT_TRUE(((a * b) * point).isApprox(a * (b * point), 1e-9));
  }
}

TEST(Se2, InterpolatesTheShortWayRound) {
  expect_near(interpolate({0, 0, 3.0}, {2, 0, -3.0}, 0.5), {1, 0, kPi});
}

std::uint64_t first_draw(std::initializer_list<std::uint64_t> key) {
  return Random{key}();
}

TEST(Random, DependsOnTheKeyOnly) {
  EXPECT_EQ(first_draw({1, 2}), first_draw({1, 2}));
  EXPECT_NE(first_draw({1, 2}), first_draw({2, 1}));
  EXPECT_NE(first_draw({1}), first_draw({1, 0}));
}

/// Recorded runs are repeated with the same draws. The values are those of SplitMix64 (Steele, Lea,
/// Flood 2014), with a state that is mixed with each part of the key.
TEST(Random, TheDrawsOfAKeyNeverChange) {
  EXPECT_EQ(first_draw({}), 0x6e789e6aa1b965f4ULL);
  Random random{1, 2};
  EXPECT_EQ(random(), 0x27d6f4e45e24533fULL);
  EXPECT_EQ(random(), 0x40b894e1bd8dbe6ULL);
}

TEST(Random, UniformDrawsAreBetweenTheirLimits) {
  Random random{3};
  double least = 5.0;
  double most = 2.0;
  for (int i = 0; i < 1000; ++i) {
    const double value = random.uniform(2.0, 5.0);
    least = std::min(least, value);
    most = std::max(most, value);
  }
  EXPECT_GE(least, 2.0);
  EXPECT_LT(least, 2.05);
  EXPECT_GT(most, 4.95);
  EXPECT_LT(most, 5.0);
}

TEST(Random, ANormalDrawIsScaledAndShifted) {
  for (std::uint64_t seed = 0; seed < 10; ++seed)
    EXPECT_EQ(Random{seed}.normal(3.0, 0.5), 3.0 + 0.5 * Random{seed}.normal());
}

TEST(Random, HasTheRightMoments) {
  double sum = 0.0;
  double sum_of_squares = 0.0;
  double uniform_sum = 0.0;
  constexpr int kDraws = 100000;
  for (std::uint64_t i = 0; i < kDraws; ++i) {
    Random random{{7, i}};  // a generator for each draw, as particles use it
    const double value = random.normal();
    sum += value;
    sum_of_squares += value * value;
    uniform_sum += random.uniform();
  }
  const double three_sigma = 3.0 / std::sqrt(kDraws);
  EXPECT_NEAR(sum / kDraws, 0.0, three_sigma);
  EXPECT_NEAR(sum_of_squares / kDraws, 1.0, three_sigma * std::sqrt(2.0));
  EXPECT_NEAR(uniform_sum / kDraws, 0.5, three_sigma * std::sqrt(1.0 / 12.0));
}

TEST(Se2, PosesOnArcsAboutOnePointKeepTheirRelativePose) {
  const double turn_rad = 0.7;
  const Se2 turn{0.0, 0.0, turn_rad};
  for (const Se2& pose : {Se2{3.0, -1.0, 0.4}, Se2{-2.0, 5.0, 2.9}}) {
    // Initial motion in the base frame.
    const Eigen::Vector2d begins =
        pose.rotation().transpose() * Eigen::Vector2d{-turn_rad * pose.y(), turn_rad * pose.x()};
    const Se2 moved = pose * along_arc({begins.x(), begins.y(), turn_rad});
    EXPECT_LT(pose_difference(moved, turn * pose).norm(), 1e-12);
  }
  const Se2 small = along_arc({0.2, 0.1, 1e-6});
  EXPECT_NEAR(small.y(), 0.1 + 0.5 * 1e-6 * 0.2, 1e-12);
}

TEST(CameraConfig, LooksForwardByDefault) {
  CameraConfig camera{};
  camera.x_m = camera.y_m = camera.z_m = 0.0;
  const Eigen::Vector3d ahead{0.0, 0.0, 1.0};
  EXPECT_TRUE((camera.base_from_camera() * ahead).isApprox(Eigen::Vector3d::UnitX()));
  camera.yaw_rad = kPi / 2.0;
  EXPECT_TRUE((camera.base_from_camera() * ahead).isApprox(Eigen::Vector3d::UnitY()));
  camera.yaw_rad = 0.0;
  camera.pitch_rad = kPi / 2.0;
  EXPECT_TRUE((camera.base_from_camera() * ahead).isApprox(-Eigen::Vector3d::UnitZ()));
}

TEST(Counters, TheKindOfACountDoesNotFollowFromItsName) {
  Counters counters;
  counters.add("late rejected words that were dropped");
  EXPECT_EQ(counters.total(CountKind::kEvent), 1);
  EXPECT_EQ(counters.total(CountKind::kLoss) + counters.total(CountKind::kRejection), 0);
  counters.add("nothing suspicious", CountKind::kRejection, 3);
  counters.add("nothing suspicious", CountKind::kRejection);
  EXPECT_EQ(counters.total(CountKind::kRejection), 4);
  EXPECT_EQ(counters.get("nothing suspicious"), 4);
  EXPECT_EQ(counters.get("something else"), 0);
}

TEST(RigidFit, RecoversTheMotionOfTransformedPoints) {
  const Se2 target_from_source{1.0, -2.0, 2.5};
  std::vector<PointPair> pairs;
  for (const Eigen::Vector2d& source :
       {Eigen::Vector2d{0.0, 0.0}, Eigen::Vector2d{3.0, 1.0}, Eigen::Vector2d{-1.0, 4.0}})
    pairs.push_back({target_from_source * source, source});
  expect_near(rigid_fit(pairs), target_from_source);
}

TEST(PrincipalAxes, EqualThoseOfARotatedEllipse) {
  const double angle_rad = 0.4;
  const Eigen::Matrix2d turn = Eigen::Rotation2Dd{angle_rad}.toRotationMatrix();
  const Eigen::Matrix2d ellipse = turn * Eigen::Vector2d{9.0, 4.0}.asDiagonal() * turn.transpose();
  const PrincipalAxes axes = principal_axes(ellipse);
  EXPECT_NEAR(axes.values(0), 4.0, 1e-12);
  EXPECT_NEAR(axes.values(1), 9.0, 1e-12);
  EXPECT_NEAR(std::abs(axes.directions.col(1).dot(turn.col(0))), 1.0, 1e-12);
  EXPECT_NEAR(axes.directions.col(0).dot(axes.directions.col(1)), 0.0, 1e-12);
}

}  // namespace
}  // namespace waymark
