// SPDX-License-Identifier: BSD-3-Clause
#include "sim/core/scenario.hpp"

#include <cmath>

namespace waymark {

RobotConfig simulated_robot() {
  RobotConfig robot;
  robot.camera.focal_sigma = 0.0001;
  robot.camera.yaw_sigma_rad = 0.0005;
  robot.camera.bearing_sigma_rad = 0.00003;
  robot.camera.position_sigma_m = 0.0001;
  robot.markers.bulge_sigma_m = 0.0005;
  robot.markers.skew_sigma_rad = 0.001;
  return robot;
}

void RunConfig::describe(Fields& fields) {
  fields.field("seed", seed, {0, 1e15}, "of all randomness");
  fields.field("tick_s", tick_s, {0.01, 10.0}, "simulated time between two TICK messages");
  fields.field("physics_rate_hz", physics_rate_hz, {100, 10000}, "physics steps per second");
  fields.field("rolling_scan", rolling_scan,
               "LIDAR as lidar_t, each beam measured at its own time; else planar_lidar_t");
  fields.field("participants", participants,
               "processes that acknowledge every tick; each waits for those before it");
  fields.field("window_ticks", window_ticks, {1, kMaxWindowTicks}, "ticks in flight at most");
}

int Scenario::steps_per(double rate_hz) const {
  return static_cast<int>(std::lround(run.physics_rate_hz / rate_hz));
}

int Scenario::steps_per_tick() const {
  return static_cast<int>(std::lround(run.physics_rate_hz * run.tick_s));
}

void Scenario::describe(Fields& fields) {
  fields.section("robot", robot);
  fields.section("world", world);
  fields.section("markers", markers);
  fields.section("odometry_errors", odometry_errors);
  fields.section("lidar_noise", lidar_noise);
  fields.section("camera_noise", camera_noise);
  fields.section("camera_errors", camera_errors);
  fields.section("run", run);
  fields.section("route", route);
  fields.section("expect", expect);
  fields.list("faults", faults, "of sensors, for a while or always");
  fields.list("kidnaps", kidnaps, "the robot is lifted and put down elsewhere, in this order");
}

}  // namespace waymark
