// SPDX-License-Identifier: BSD-3-Clause
#include "sim/core/robot/drive.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace waymark {
namespace {

constexpr double kPeriod_s = 0.01;

/// All poses of a robot without inertia or slip that follows the route to its end.
std::vector<Se2> drive_ideal_robot(const RouteConfig& config) {
  RouteFollower follower{config, kPeriod_s};
  Se2 world_from_base = config.world_from_start();
  std::vector<Se2> poses;
  while (!follower.arrived() && poses.size() < 100'000) {
    const Velocity velocity = follower.next(world_from_base);
    world_from_base = world_from_base *
                      Se2{velocity.forward_mps * kPeriod_s, 0.0, velocity.turn_radps * kPeriod_s};
    poses.push_back(world_from_base);
  }
  EXPECT_TRUE(follower.arrived());
  return poses;
}

RouteConfig short_route() {
  RouteConfig config{};
  config.end_x_m = 4.0;
  return config;
}

TEST(WheelSpeeds, MatchTheGeometryStraightOnAndOnTheSpot) {
  const BaseConfig base{};
  const WheelPair straight = wheel_speeds(base, {0.33, 0.0});
  EXPECT_DOUBLE_EQ(straight.left, 10.0);
  EXPECT_DOUBLE_EQ(straight.right, 10.0);
  const WheelPair to_the_left = wheel_speeds(base, {0.0, 1.0});
  EXPECT_DOUBLE_EQ(to_the_left.right, 0.287 / 2 / 0.033);
  EXPECT_DOUBLE_EQ(to_the_left.left, -to_the_left.right);
}

TEST(RouteFollower, DrivesStraightToTheEndInTheExpectedTime) {
  const auto poses = drive_ideal_robot(short_route());

  EXPECT_NEAR(poses.back().x(), 4.0, 0.002);
  EXPECT_EQ(poses.back().y(), 0.0);
  // 3 m at 0.1 m/s, with half a second each for speeding up and slowing down, and a short creep.
  EXPECT_NEAR(static_cast<double>(poses.size()) * kPeriod_s, 30.5, 1.0);
}

TEST(RouteFollower, RespectsSpeedAndAcceleration) {
  const RouteConfig config = short_route();
  RouteFollower follower{config, kPeriod_s};
  double last_mps = 0.0;
  for (double x = 1.0; x < 3.9; x += 0.001) {
    const Velocity velocity = follower.next({x, 0.0, 0.0});
    EXPECT_LE(velocity.forward_mps, config.speed_mps);
    EXPECT_LE(velocity.forward_mps - last_mps, config.acceleration_mps2 * kPeriod_s + 1e-12);
    last_mps = velocity.forward_mps;
  }
  EXPECT_DOUBLE_EQ(last_mps, config.speed_mps);
}

TEST(RouteFollower, ReturnsToTheLineWithoutOvershooting) {
  const RouteConfig config = short_route();
  RouteFollower follower{config, kPeriod_s};
  follower.next(config.world_from_start());  // aligned: driving from now on
  Se2 world_from_base{1.0, 0.1, 0.0};
  while (!follower.arrived()) {
    const Velocity velocity = follower.next(world_from_base);
    world_from_base = world_from_base *
                      Se2{velocity.forward_mps * kPeriod_s, 0.0, velocity.turn_radps * kPeriod_s};
    EXPECT_GT(world_from_base.y(), -0.005);
  }
  EXPECT_NEAR(world_from_base.y(), 0.0, 0.01);
}

TEST(RouteFollower, VisitsWaypointsWithTurnsOnTheSpot) {
  RouteConfig config{};
  config.start_yaw_rad = std::numbers::pi;
  config.waypoints = {{3.0, 0.0}, {3.0, 0.5}, {1.0, 0.5}};

  const auto poses = drive_ideal_robot(config);

  for (const Waypoint& waypoint : config.waypoints) {
    const auto distance_m = [&waypoint](const Se2& pose) {
      return std::hypot(pose.x() - waypoint.x_m, pose.y() - waypoint.y_m);
    };
    double nearest_m = 1e9;
    for (const Se2& pose : poses)
      nearest_m = std::min(nearest_m, distance_m(pose));
    EXPECT_LT(nearest_m, 0.01);
  }
  EXPECT_NEAR(std::abs(poses.back().theta()), std::numbers::pi, 0.01);
}

TEST(RouteFollower, DrivesThroughRoundedCornersWithoutStopping) {
  RouteConfig config{};
  config.corner_radius_m = 0.6;
  config.laps = 2;
  config.waypoints = {{5.0, 0.0}, {5.0, 4.0}, {1.0, 4.0}, {1.0, 0.0}};
  RouteFollower follower{config, kPeriod_s};
  Se2 world_from_base = config.world_from_start();
  double slowest_mps = config.speed_mps;
  while (follower.progress_m() < 29.0) {
    const Velocity velocity = follower.next(world_from_base);
    world_from_base = world_from_base *
                      Se2{velocity.forward_mps * kPeriod_s, 0.0, velocity.turn_radps * kPeriod_s};
    if (follower.progress_m() < 0.1) continue;  // it has sped up
    slowest_mps = std::min(slowest_mps, velocity.forward_mps);
    // Never far from the sides of the square, cutting corners by (sqrt 2 - 1) radii at most.
    const double off_m = std::min(
        std::min(std::abs(world_from_base.y()), std::abs(world_from_base.y() - 4.0)),
        std::min(std::abs(world_from_base.x() - 1.0), std::abs(world_from_base.x() - 5.0)));
    EXPECT_LT(off_m, 0.21);
  }
  EXPECT_NEAR(slowest_mps, config.speed_mps, 1e-9);
  EXPECT_NEAR(follower.route_length_m(), 32.0 - 7 * (2.0 - 0.5 * std::numbers::pi) * 0.6, 1e-9);
}

TEST(RouteFollower, LengthAndProgressAreMeasuredAlongTheRoute) {
  RouteConfig config{};
  config.waypoints = {{2.0, 0.0}, {2.0, 0.5}};
  RouteFollower follower{config, kPeriod_s};
  EXPECT_DOUBLE_EQ(follower.route_length_m(), 1.5);
  follower.next({1.25, 0.0, 0.0});
  EXPECT_DOUBLE_EQ(follower.progress_m(), 0.25);
}

TEST(CommandFollower, ACommandActsAFixedTimeAfterItsStamp) {
  const Duration delay{500'000};
  CommandFollower follower{{}, delay, kPeriod_s};
  EXPECT_EQ(follower.receive(timestamp_from_us(100'000), {0.2, 0.0}), CommandOutcome::kInTime);

  EXPECT_EQ(follower.next(timestamp_from_us(599'999)).forward_mps, 0.0);
  EXPECT_GT(follower.next(timestamp_from_us(600'000)).forward_mps, 0.0);
}

TEST(CommandFollower, LateCommandsAreReportedAndFollowed) {
  CommandFollower follower{{}, Duration{500'000}, kPeriod_s};
  follower.next(timestamp_from_us(2'000'000));
  EXPECT_EQ(follower.receive(timestamp_from_us(1'000'000), {0.2, 0.0}), CommandOutcome::kLate);
  EXPECT_GT(follower.next(timestamp_from_us(2'010'000)).forward_mps, 0.0);
}

TEST(CommandFollower, ACommandOlderThanTheActiveOneIsIgnored) {
  CommandFollower follower{{}, Duration{500'000}, kPeriod_s};
  follower.receive(timestamp_from_us(1'000'000), {0.0, 0.0});
  follower.next(timestamp_from_us(1'500'000));

  EXPECT_EQ(follower.receive(timestamp_from_us(999'999), {0.2, 0.0}), CommandOutcome::kOutdated);
  EXPECT_EQ(follower.next(timestamp_from_us(1'510'000)).forward_mps, 0.0);
}

TEST(CommandFollower, TheQueueOfCommandsIsBounded) {
  CommandFollower follower{{}, Duration{500'000}, kPeriod_s};
  int num_refused = 0;
  for (int i = 0; i < 100'000; ++i) {
    const auto outcome = follower.receive(timestamp_from_us(1'000'000 + i), {0.2, 0.0});
    if (outcome == CommandOutcome::kTooMany) ++num_refused;
  }
  EXPECT_EQ(num_refused, 90'000);
}

TEST(CommandFollower, CommandsActInTheOrderOfTheirStampsNotOfArrival) {
  const std::vector<std::pair<std::int64_t, double>> commands{{0, 0.1}, {50'000, 0.3}};
  CommandFollower in_order{{}, Duration{100'000}, kPeriod_s};
  CommandFollower reversed{{}, Duration{100'000}, kPeriod_s};
  for (const auto& [stamp_us, speed_mps] : commands)
    in_order.receive(timestamp_from_us(stamp_us), {speed_mps, 0.0});
  for (auto it = commands.rbegin(); it != commands.rend(); ++it)
    reversed.receive(timestamp_from_us(it->first), {it->second, 0.0});
  for (std::int64_t now_us = 0; now_us < 3'000'000; now_us += 10'000) {
    const Timestamp now = timestamp_from_us(now_us);
    EXPECT_EQ(in_order.next(now).forward_mps, reversed.next(now).forward_mps);
  }
}

TEST(RouteFollower, TheTimeLimitCountsTurns) {
  RouteConfig route{};
  route.waypoints = {{2.0, 0.0}, {2.0, 1.0}, {1.0, 1.0}, {1.0, 0.0}};
  route.laps = 5;
  const double limit_s = RouteFollower{route, kPeriod_s}.time_limit_s();
  route.turn_speed_radps = 0.02;
  // 19 corners of a quarter turn; a turn takes 1.6 s / 0.02 = 79 s instead of 3 s.
  EXPECT_GT(RouteFollower(route, kPeriod_s).time_limit_s(), limit_s + 19 * 75.0);
  route.duration_s = 7.0;
  EXPECT_EQ(RouteFollower(route, kPeriod_s).time_limit_s(), 7.0);
}

}  // namespace
}  // namespace waymark
