// SPDX-License-Identifier: BSD-3-Clause
#include "sim/core/simulation.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

namespace waymark {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

/// A fast test: a short corridor and a small camera.
Scenario small_scenario() {
  Scenario scenario{};
  scenario.world.length_m = 6.0;
  scenario.markers.last_m = 4.0;
  scenario.route.end_x_m = 2.0;
  scenario.route.speed_mps = 0.5;
  scenario.robot.camera.width_px = 160;
  scenario.robot.camera.height_px = 120;
  scenario.robot.camera.fx_px = scenario.robot.camera.fy_px = 132.0;
  scenario.robot.camera.cx_px = 79.5;
  scenario.robot.camera.cy_px = 59.5;
  return scenario;
}

std::vector<std::int64_t> odometry_times_us(const Tick& tick) {
  std::vector<std::int64_t> times;
  for (const OdometrySample& sample : tick.odometry)
    times.push_back(to_us(sample.time));
  return times;
}

TEST(Simulation, TicksHoldEachSensorAtItsRate) {
  Simulation simulation{small_scenario()};
  const Tick first = simulation.advance();
  const Tick second = simulation.advance();

  EXPECT_EQ(to_us(first.end), 100'000);
  EXPECT_THAT(odometry_times_us(first), ElementsAre(0, 33'333, 66'667));
  EXPECT_THAT(odometry_times_us(second), ElementsAre(100'000, 133'333, 166'667));
  EXPECT_EQ(first.true_poses.size(), 3U);
  EXPECT_EQ(first.scans.size(), 1U);
  EXPECT_EQ(second.scans.size(), 0U);
  ASSERT_EQ(second.frames.size(), 1U);
  EXPECT_EQ(to_us(second.frames[0].time), 100'000);
  EXPECT_EQ(first.odometry[0].odom_from_base.x(), 0.0);
  EXPECT_NEAR(first.true_poses[0].world_from_base.x(), 1.0, 1e-4);
}

TEST(Simulation, DrivesTheRouteAndStops) {
  Simulation simulation{small_scenario()};
  Tick last;
  int ticks = 0;
  while (!simulation.finished() && ++ticks < 200)
    last = simulation.advance();

  EXPECT_TRUE(simulation.finished());
  EXPECT_EQ(simulation.progress_fraction(), 1.0);
  EXPECT_NEAR(simulation.world_from_base().x(), 2.0, 0.005);
  EXPECT_NEAR(simulation.world_from_base().y(), 0.0, 0.002);
  // Odometry is 1 % too long with seed 1; tolerance: three sigma of 3 mm per root metre.
  EXPECT_NEAR(last.odometry.back().odom_from_base.x(), 1.01, 0.012);
}

TEST(Simulation, TheSameScenarioGivesTheSameBytes) {
  Simulation a{small_scenario()};
  Simulation b{small_scenario()};
  for (int i = 0; i < 12; ++i) {
    const Tick tick_a = a.advance();
    const Tick tick_b = b.advance();
    EXPECT_EQ(tick_a.frames[0].jpeg, tick_b.frames[0].jpeg);
    EXPECT_EQ(tick_a.odometry.back().odom_from_base.x(), tick_b.odometry.back().odom_from_base.x());
    EXPECT_EQ(tick_a.true_poses.back().world_from_base.x(),
              tick_b.true_poses.back().world_from_base.x());
    ASSERT_EQ(tick_a.scans.size(), tick_b.scans.size());
    if (tick_a.scans.empty()) continue;
    EXPECT_EQ(tick_a.scans[0].ranges_m[90], tick_b.scans[0].ranges_m[90]);
  }
}

TEST(Simulation, AnotherSeedGivesAnotherImage) {
  Scenario other_seed = small_scenario();
  other_seed.run.seed = 2;
  EXPECT_NE(Simulation{small_scenario()}.advance().frames[0].jpeg,
            Simulation{other_seed}.advance().frames[0].jpeg);
}

/// The camera's frame after two seconds of an even turn to the left, without noise.
cv::Mat frame_while_turning(double exposure_s) {
  Scenario scenario = small_scenario();
  scenario.route.source = DriveSource::kCommand;
  scenario.route.duration_s = 10.0;
  scenario.camera_noise = {.sigma_grey_levels = 0.0, .exposure_s = exposure_s, .jpeg_quality = 95};
  Simulation simulation{scenario};
  simulation.command(timestamp_from_us(0), {0.0, 0.5});
  Tick tick;
  for (int i = 0; i < 20; ++i)
    tick = simulation.advance();
  cv::Mat picture;
  cv::imdecode(tick.frames.back().jpeg, cv::IMREAD_GRAYSCALE).convertTo(picture, CV_32F);
  return picture;
}

TEST(Simulation, AnExposedFrameIsBlurredByMotionAboutTheTimeOfItsStamp) {
  const cv::Mat sharp = frame_while_turning(0.0);
  const cv::Mat blurred = frame_while_turning(0.1);  // 0.05 rad, 6.6 px in the middle
  cv::Mat edges, blurred_edges;
  cv::Sobel(sharp, edges, CV_32F, 1, 0);
  cv::Sobel(blurred, blurred_edges, CV_32F, 1, 0);
  EXPECT_LT(cv::norm(blurred_edges), 0.8 * cv::norm(edges));
  EXPECT_NEAR(cv::mean(blurred)[0], cv::mean(sharp)[0], 1.0) << "no brighter or darker";
  // Centred: it differs as much from the sharp picture shifted to the left as to the right.
  constexpr int kShift_px = 3;
  const auto difference = [&](int shift_px) {
    const cv::Range columns{kShift_px, sharp.cols - kShift_px};
    const cv::Range shifted{columns.start + shift_px, columns.end + shift_px};
    return cv::norm(blurred.colRange(columns), sharp.colRange(shifted));
  };
  EXPECT_NEAR(difference(-kShift_px) / difference(kShift_px), 1.0, 0.1);
}

TEST(Simulation, ARollingScanTakesItsBeamsOneAfterTheOther) {
  Scenario scenario = small_scenario();
  scenario.run.rolling_scan = true;
  Simulation simulation{scenario};
  EXPECT_TRUE(simulation.advance().scans.empty());  // half a sweep
  const Tick second = simulation.advance();
  ASSERT_EQ(second.scans.size(), 1U);
  const LidarScan& scan = second.scans[0];
  ASSERT_EQ(scan.ranges_m.size(), 360U);
  ASSERT_EQ(scan.beam_time_offsets.size(), 360U);
  EXPECT_EQ(to_us(scan.time + scan.beam_time_offsets.front()), 0);
  EXPECT_EQ(scan.beam_time_offsets.back(), Duration{0});
  EXPECT_TRUE(std::is_sorted(scan.beam_time_offsets.begin(), scan.beam_time_offsets.end()));
  EXPECT_LT(scan.time, second.end);
}

TEST(Simulation, CommandsActAFixedTimeLater) {
  Scenario scenario = small_scenario();
  scenario.route.source = DriveSource::kCommand;
  scenario.route.duration_s = 2.0;
  Simulation simulation{scenario};
  EXPECT_EQ(simulation.command(timestamp_from_us(0), {0.2, 0.0}), CommandOutcome::kInTime);
  for (int i = 0; i < 8; ++i)
    simulation.advance();
  EXPECT_NEAR(simulation.world_from_base().x(), 1.0, 1e-4);
  for (int i = 0; i < 12; ++i)
    simulation.advance();
  EXPECT_TRUE(simulation.finished());
  EXPECT_NEAR(simulation.world_from_base().x(), 1.0 + 0.2 * 1.2 - 0.1, 0.01);
}

TEST(Simulation, ARobotThatNeverArrivesIsAnError) {
  Scenario scenario = small_scenario();
  scenario.route.duration_s = 0.3;
  Simulation simulation{scenario};
  try {
    for (int i = 0; i < 4; ++i)
      simulation.advance();
    FAIL() << "no error";
  } catch (const SimulatorError& error) {
    EXPECT_THAT(error.what(), HasSubstr("route.duration_s"));
    EXPECT_THAT(error.what(), HasSubstr("1.00 m from a wall or box"));
  }
}

TEST(Simulation, EventsThatHaveNotBegunArePending) {
  Scenario scenario = small_scenario();
  scenario.route.end_x_m = 1.2;
  scenario.route.settle_s = 0.0;
  scenario.faults = {{.during = {.from_m = 0.1, .to_m = 0.12}}, {.during = {.from_s = 50.0}}};
  scenario.kidnaps = {{.when = {.at_m = 0.3}, .to_x_m = 3.0}};
  scenario.markers.moved = {{0, {.at_s = 0.2}, 0.1, 0.0}};
  Simulation simulation{scenario};
  while (!simulation.finished())
    simulation.advance();
  ASSERT_EQ(simulation.pending_events().size(), 2U);
  EXPECT_EQ(simulation.pending_events()[0].key, "faults[1]");
  EXPECT_EQ(simulation.pending_events()[1].key, "kidnaps[0]");
}

}  // namespace
}  // namespace waymark
