// SPDX-License-Identifier: BSD-3-Clause
#include "sim/core/simulation.hpp"

#include "sim/core/world/mjcf.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace waymark {
namespace {

constexpr std::int64_t kNotYet = -1;
// A route takes this much longer than its length over its speed before something is wrong.
constexpr double kPatienceFactor = 3.0;
constexpr double kPatience_s = 60.0;

std::string mjcf_of(const Scenario& scenario, const World& world, const Pinhole& pinhole) {
  MjcfOptions options;
  options.time_step_s = 1.0 / scenario.run.physics_rate_hz;
  options.plate_size_m = plate_size_m(scenario.marker_print());
  options.picture_width_px = pinhole.width_px;
  options.picture_height_px = pinhole.height_px;
  options.world_from_start = scenario.route.world_from_start();
  return to_mjcf(world, scenario.robot, options);
}

PlatePrint plate_print(const Scenario& scenario) {
  return scenario.markers.blank ? PlatePrint::kBlank : PlatePrint::kMarkers;
}

}  // namespace

Simulation::Simulation(const Scenario& scenario)
    : scenario_{scenario},
      world_{straight_corridor(scenario.world, scenario.markers)},
      camera_{scenario.robot.camera, scenario.camera_noise, scenario.run.seed},
      physics_{mjcf_of(scenario, world_, camera_.pinhole())},
      route_{scenario.route, 1.0 / scenario.run.physics_rate_hz},
      commands_{scenario.route,
                scenario.route.command_delay_ticks * duration_from_seconds(scenario.run.tick_s),
                1.0 / scenario.run.physics_rate_hz},
      encoders_{scenario.robot.base, scenario.odometry_errors, scenario.run.seed},
      lidar_{scenario.robot.lidar, scenario.lidar_noise, scenario.run.seed},
      renderer_{world_, scenario.marker_print(), plate_print(scenario), camera_.pinhole(),
                physics_} {}

Tick Simulation::advance() {
  Tick tick;
  for (int i = 0; i < scenario_.steps_per_tick(); ++i) {
    sense(tick);
    physics_.step(wheel_speeds(scenario_.robot.base, decide()));
    ++step_;
  }
  tick.end = now();
  check_progress();
  return tick;
}

bool Simulation::command(Timestamp stamp, const Velocity& velocity) {
  return commands_.receive(stamp, velocity);
}

bool Simulation::finished() const {
  if (scenario_.route.source == DriveSource::kCommand) {
    return to_seconds(now()) >= scenario_.route.duration_s;
  }
  return arrival_step_ != kNotYet &&
         to_seconds(now() - time_of_step(arrival_step_)) >= scenario_.route.settle_s;
}

double Simulation::progress_fraction() const {
  if (finished()) return 1.0;
  if (scenario_.route.source == DriveSource::kCommand) {
    return to_seconds(now()) / scenario_.route.duration_s;
  }
  return route_.route_length_m() > 0.0 ? route_.progress_m() / route_.route_length_m() : 0.0;
}

Timestamp Simulation::time_of_step(std::int64_t step) const {
  // From the step number, so that no rounding adds up.
  const std::int64_t rate_hz = scenario_.run.physics_rate_hz;
  return timestamp_from_us((step * 1'000'000 + rate_hz / 2) / rate_hz);
}

bool Simulation::is_due(double rate_hz) const {
  return step_ % scenario_.steps_per(rate_hz) == 0;
}

void Simulation::sense(Tick& tick) {
  if (is_due(scenario_.robot.base.odometry_rate_hz)) {
    tick.odometry.push_back(encoders_.measure(now(), physics_.wheel_angles()));
    tick.true_poses.push_back({now(), physics_.world_from_base()});
  }
  if (scenario_.run.rolling_scan) {
    sense_rolling_scan(tick);
  } else if (is_due(scenario_.robot.lidar.rate_hz)) {
    tick.scans.push_back(lidar_.scan(now(), physics_));
  }
  if (is_due(scenario_.robot.camera.rate_hz)) tick.frames.push_back(photograph());
}

/// A few beams in every step; a finished sweep is stamped with the time of its last beams, so that
/// messages stay in order of time.
void Simulation::sense_rolling_scan(Tick& tick) {
  const int num_beams = scenario_.robot.lidar.num_beams;
  const int steps_per_sweep = scenario_.steps_per(scenario_.robot.lidar.rate_hz);
  const int phase = static_cast<int>(step_ % steps_per_sweep);
  if (phase == 0) {
    sweep_ = {};
    sweep_.time = now();
  }
  const int beams_by_now =
      static_cast<int>(std::int64_t{num_beams} * (phase + 1) / steps_per_sweep);
  const int beams_before = static_cast<int>(sweep_.ranges_m.size());
  lidar_.add_beams(sweep_, beams_by_now - beams_before, physics_);
  sweep_.beam_time_offsets.resize(sweep_.ranges_m.size(), now() - sweep_.time);
  if (beams_by_now < num_beams) return;
  for (Duration& offset : sweep_.beam_time_offsets)
    offset -= now() - sweep_.time;
  sweep_.time = now();
  tick.scans.push_back(sweep_);
}

CameraFrame Simulation::photograph() {
  const Eigen::Isometry3d world_from_camera =
      physics_.world_from_base_3d() * scenario_.robot.camera.base_from_camera();
  const cv::Mat picture = camera_.expose(renderer_.render(world_from_camera), frames_taken_++);
  return camera_.compress(picture, now());
}

Velocity Simulation::decide() {
  if (scenario_.route.source == DriveSource::kCommand) return commands_.next(now());
  const Velocity velocity = route_.next(physics_.world_from_base());
  if (route_.arrived() && arrival_step_ == kNotYet) arrival_step_ = step_;
  return velocity;
}

void Simulation::check_progress() const {
  if (scenario_.route.source == DriveSource::kCommand || route_.arrived()) return;
  const double patience_s =
      scenario_.route.duration_s > 0.0
          ? scenario_.route.duration_s
          : kPatience_s + kPatienceFactor * route_.route_length_m() / scenario_.route.speed_mps;
  if (to_seconds(now()) < patience_s) return;
  const Se2 at = physics_.world_from_base();
  throw SimulatorError{
      fmt::format("the robot has not arrived after {:.0f} s; it stands at ({:.2f}, {:.2f})",
                  to_seconds(now()), at.x(), at.y())};
}

}  // namespace waymark
