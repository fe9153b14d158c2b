// SPDX-License-Identifier: BSD-3-Clause
// Kidnaps, sensor faults and moved markers in a simulation.
#include "sim/core/simulation.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

namespace waymark {
namespace {

/// A fast test: 8 m at 0.5 m/s, with a small camera.
Scenario small_scenario() {
  Scenario scenario{};
  scenario.world.length_m = 8.0;
  scenario.markers.last_m = 4.0;
  scenario.route.start_x_m = 4.0;
  scenario.route.end_x_m = 5.0;
  scenario.route.speed_mps = 0.5;
  scenario.odometry_errors = {.draw_from_seed = false,
                              .diffusion_m_per_sqrt_m = 0.0,
                              .heading_diffusion_deg_per_sqrt_m = 0.0};
  scenario.lidar_noise = {.range_sigma_m = 0.0, .dropout_probability = 0.0};
  scenario.robot.camera.width_px = 80;
  scenario.robot.camera.height_px = 60;
  scenario.robot.camera.fx_px = scenario.robot.camera.fy_px = 66.0;
  scenario.robot.camera.cx_px = 39.5;
  scenario.robot.camera.cy_px = 29.5;
  scenario.robot.camera.rate_hz = 5.0;
  return scenario;
}

std::vector<Tick> all_ticks(const Scenario& scenario) {
  Simulation simulation{scenario};
  std::vector<Tick> ticks;
  while (!simulation.finished())
    ticks.push_back(simulation.advance());
  return ticks;
}

FaultConfig fault(Sensor sensor, FaultKind kind, Span during = {}) {
  FaultConfig config{};
  config.sensor = sensor;
  config.kind = kind;
  config.during = during;
  return config;
}

TEST(Kidnap, TheTruePoseJumpsOdometryDoesNotAndTheRouteIsFinished) {
  Scenario scenario = small_scenario();
  scenario.kidnaps = {{{.at_m = 0.5}, 2.0, 0.1, 0.2}};
  double largest_true_m = 0.0, largest_counted_m = 0.0, counted_m = 0.0;
  Se2 true_before{4.0, 0.0, 0.0}, odom_before{};
  for (const Tick& tick : all_ticks(scenario)) {
    for (const TruePose& pose : tick.true_poses) {
      const double step_m = (pose.world_from_base.translation() - true_before.translation()).norm();
      if (step_m > largest_true_m) {
        EXPECT_TRUE(step_m < 0.1 || std::abs(pose.world_from_base.theta() - 0.2) < 1e-6);
        largest_true_m = step_m;
      }
      true_before = pose.world_from_base;
    }
    for (const OdometrySample& sample : tick.odometry) {
      const double step_m =
          (sample.odom_from_base.translation() - odom_before.translation()).norm();
      largest_counted_m = std::max(largest_counted_m, step_m);
      counted_m += step_m;
      odom_before = sample.odom_from_base;
    }
  }
  EXPECT_NEAR(largest_true_m, 2.5, 0.1);  // from x = 4.5 m, where it had been stopped, to 2 m
  EXPECT_LT(largest_counted_m, 0.02);
  EXPECT_NEAR(counted_m, 0.5 + 3.0, 0.1);
  EXPECT_NEAR(true_before.x(), 5.0, 0.01);
  EXPECT_NEAR(true_before.y(), 0.0, 0.02);
}

TEST(Faults, ALidarThatIsStuckRepeatsItsScan) {
  Scenario scenario = small_scenario();
  scenario.lidar_noise.range_sigma_m = 0.01;
  scenario.faults = {fault(Sensor::kLidar, FaultKind::kStuck, {.from_s = 1.0, .to_s = 2.0})};
  const LidarScan* last = nullptr;
  const std::vector<Tick> ticks = all_ticks(scenario);
  int repeated = 0;
  for (const Tick& tick : ticks) {
    for (const LidarScan& scan : tick.scans) {
      if (last != nullptr && last->ranges_m == scan.ranges_m) ++repeated;
      last = &scan;
    }
  }
  EXPECT_EQ(repeated, 5);
}

TEST(Faults, ADisabledCameraSendsNothing) {
  Scenario scenario = small_scenario();
  scenario.faults = {fault(Sensor::kCamera, FaultKind::kOff)};
  for (const Tick& tick : all_ticks(scenario))
    EXPECT_TRUE(tick.frames.empty());
}

TEST(Faults, ADelayedFrameIsStampedInTheTickThatSendsIt) {
  Scenario scenario = small_scenario();
  scenario.faults = {fault(Sensor::kCamera, FaultKind::kDelayed)};
  scenario.faults[0].delay_s = 0.15;
  Timestamp begin{};
  std::size_t count = 0;
  for (const Tick& tick : all_ticks(scenario)) {
    for (const CameraFrame& frame : tick.frames) {
      EXPECT_EQ(to_us(frame.time) % 200'000, 150'000);
      EXPECT_GE(frame.time, begin);
      EXPECT_LT(frame.time, tick.end);
      ++count;
    }
    begin = tick.end;
  }
  EXPECT_GT(count, 10U);
}

TEST(Faults, FaultsThatNeverBeginLeaveTheOutputUnchanged) {
  Scenario later = small_scenario();
  later.faults = {fault(Sensor::kLidar, FaultKind::kGarbage, {.from_s = 1000.0}),
                  fault(Sensor::kCamera, FaultKind::kStuck, {.from_s = 1000.0})};
  const std::vector<Tick> plain = all_ticks(small_scenario());
  const std::vector<Tick> with_faults = all_ticks(later);
  ASSERT_EQ(plain.size(), with_faults.size());
  for (std::size_t i = 0; i < plain.size(); ++i) {
    ASSERT_EQ(plain[i].frames.size(), with_faults[i].frames.size());
    for (std::size_t k = 0; k < plain[i].frames.size(); ++k)
      EXPECT_EQ(plain[i].frames[k].jpeg, with_faults[i].frames[k].jpeg);
    for (std::size_t k = 0; k < plain[i].scans.size(); ++k)
      EXPECT_EQ(plain[i].scans[k].ranges_m[90], with_faults[i].scans[k].ranges_m[90]);
  }
}

TEST(SceneDynamics, ABoxIsVisibleOnlyDuringItsTimes) {
  Scenario scenario = small_scenario();
  BoxConfig box{};
  box.x_m = 4.4;
  box.y_m = 0.6;
  box.length_m = box.width_m = 0.4;
  box.present = {.from_s = 0.9, .to_s = 1.9};
  scenario.world.boxes = {box};
  scenario.route.speed_mps = 0.01;
  scenario.route.end_x_m = 4.01;
  Simulation simulation{scenario};
  // From the LiDAR at x = 3.94 m, 45 degrees to the left: the box's face at y = 0.4 m, or the wall.
  for (int i = 0; i < 30; ++i) {
    for (const LidarScan& scan : simulation.advance().scans) {
      const bool is_present = to_seconds(scan.time) >= 0.9 && to_seconds(scan.time) < 1.9;
      EXPECT_NEAR(scan.ranges_m[45], (is_present ? 0.4 : 1.0) * std::sqrt(2.0), 0.02)
          << to_seconds(scan.time);
    }
  }
}

TEST(SceneDynamics, AMovedMarkerIsReportedOnceAndSeenAtItsNewPlace) {
  Scenario scenario = small_scenario();
  scenario.camera_noise.sigma_grey_levels = 0.0;
  scenario.route.start_x_m = 1.0;
  scenario.route.end_x_m = 1.01;
  scenario.route.speed_mps = 0.01;
  Scenario moving = scenario;
  moving.markers.moved = {{0, {.at_s = 0.5}, 1.5, 0.0}};
  const std::vector<Tick> still_ticks = all_ticks(scenario);
  const std::vector<Tick> ticks = all_ticks(moving);
  std::vector<MovedMarker> moved;
  for (const Tick& tick : ticks)
    moved.insert(moved.end(), tick.moved_markers.begin(), tick.moved_markers.end());
  ASSERT_EQ(moved.size(), 1U);
  EXPECT_EQ(moved[0].marker.id, 0);
  EXPECT_EQ(to_us(moved[0].time), 500'000);
  EXPECT_NEAR(moved[0].marker.centre_m.x(), 5.5, 1e-12);
  EXPECT_EQ(ticks[0].frames[0].jpeg, still_ticks[0].frames[0].jpeg);
  EXPECT_NE(ticks[6].frames[0].jpeg, still_ticks[6].frames[0].jpeg);
}

TEST(RealCamera, TheTrueCameraDiffersFromTheNominalOneByTheConfiguredErrors) {
  const CameraConfig real = real_camera({}, {.focal_share = 0.005, .yaw_deg = 0.3}, 1);
  EXPECT_NEAR(real.fx_px, 1.005 * CameraConfig{}.fx_px, 1e-9);
  EXPECT_NEAR(real.yaw_rad, radians(0.3), 1e-12);
}

TEST(RealCamera, ErrorsDifferBetweenSeedsByTheConfiguredSigmas) {
  constexpr int kRuns = 2000;
  const CameraErrorConfig errors{.focal_share = 0.002, .focal_sigma = 0.001, .yaw_sigma_deg = 0.5};
  double focal = 0.0;
  double focal_squares = 0.0;
  double yaw_squares = 0.0;
  for (int seed = 1; seed <= kRuns; ++seed) {
    const CameraConfig real = real_camera({}, errors, seed);
    EXPECT_EQ(real.fx_px, real_camera({}, errors, seed).fx_px);
    const double share = real.fx_px / CameraConfig{}.fx_px - 1.0 - errors.focal_share;
    focal += share / kRuns;
    focal_squares += share * share / kRuns;
    yaw_squares += real.yaw_rad * real.yaw_rad / kRuns;
  }
  EXPECT_NEAR(focal, 0.0, 0.0001);
  EXPECT_NEAR(std::sqrt(focal_squares), errors.focal_sigma, 0.00006);
  EXPECT_NEAR(std::sqrt(yaw_squares), radians(errors.yaw_sigma_deg), radians(0.03));
}

}  // namespace
}  // namespace waymark
