// SPDX-License-Identifier: BSD-3-Clause
#include "sim/core/simulation.hpp"

#include "sim/core/world/mjcf.hpp"

#include <fmt/format.h>

namespace waymark {
namespace {

constexpr std::int64_t kNotYet = -1;
constexpr int kPicturesPerExposure = 5;

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
      world_{build_world(scenario.world, scenario.markers, plate_size_m(scenario.marker_print()),
                         scenario.run.seed)},
      camera_{real_camera(scenario.robot.camera, scenario.camera_errors, scenario.run.seed),
              scenario.camera_noise, scenario.run.seed},
      physics_{mjcf_of(scenario, world_, camera_.pinhole())},
      route_{scenario.route, 1.0 / scenario.run.physics_rate_hz},
      commands_{scenario.route,
                scenario.route.command_delay_ticks * duration_from_seconds(scenario.run.tick_s),
                1.0 / scenario.run.physics_rate_hz},
      wheel_odometry_{scenario.robot.base, scenario.odometry_errors, scenario.run.seed},
      lidar_{scenario.robot.lidar, scenario.lidar_noise, scenario.run.seed},
      renderer_{world_, scenario.marker_print(), plate_print(scenario), camera_.pinhole(),
                physics_},
      scene_dynamics_{world_},
      kidnapper_{scenario.kidnaps},
      pending_events_{scenario},
      odometry_outlet_{Faults{Sensor::kOdometry, scenario.faults}, scenario.run.seed},
      lidar_outlet_{Faults{Sensor::kLidar, scenario.faults}, scenario.run.seed},
      camera_outlet_{Faults{Sensor::kCamera, scenario.faults}, scenario.run.seed} {}

Tick Simulation::advance() {
  Tick tick;
  tick.moved_markers = scene_dynamics_.update(now(), moment(), physics_);
  for (int i = 0; i < scenario_.steps_per_tick(); ++i) {
    measure(tick);
    physics_.step(wheel_speeds(scenario_.robot.base, next_velocity()));
    ++step_;
  }
  tick.end = now();
  tick.odometry = odometry_outlet_.release(tick.end);
  tick.scans = lidar_outlet_.release(tick.end);
  tick.frames = camera_outlet_.release(tick.end);
  check_progress();
  return tick;
}

CommandOutcome Simulation::command(Timestamp stamp, const Velocity& velocity) {
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
  // Computed from the step number, so that rounding errors do not add up.
  const std::int64_t rate_hz = scenario_.run.physics_rate_hz;
  return timestamp_from_us((step * 1'000'000 + rate_hz / 2) / rate_hz);
}

bool Simulation::is_due(double rate_hz) const {
  return step_ % scenario_.steps_per(rate_hz) == 0;
}

Moment Simulation::moment() const {
  return {to_seconds(now()), route_.progress_m()};
}

void Simulation::measure(Tick& tick) {
  pending_events_.update(moment());
  if (is_due(scenario_.robot.base.odometry_rate_hz)) {
    measure_odometry();
    tick.true_poses.push_back({now(), physics_.world_from_base()});
  }
  if (scenario_.run.rolling_scan) {
    measure_rolling_scan();
  } else if (is_due(scenario_.robot.lidar.rate_hz)) {
    send_scan(lidar_.scan(now(), physics_));
  }
  if (is_due(scenario_.robot.camera.rate_hz)) {
    CameraFrame frame = capture_frame();
    frame.time += duration_from_seconds(scenario_.robot.camera.late_s);
    camera_outlet_.push(std::move(frame), moment());
  }
}

void Simulation::measure_odometry() {
  const Faults& faults = odometry_outlet_.faults();
  OdometrySample sample = wheel_odometry_.measure(
      now(), spinning_wheels_.counted(physics_.wheel_angles(), faults, moment()));
  if (faults.active(FaultKind::kGarbage, moment()) != nullptr) {
    Random random = garbage_random(Sensor::kOdometry);
    make_garbage(sample, random);
  }
  odometry_outlet_.push(sample, moment());
}

void Simulation::send_scan(LidarScan scan) {
  const Faults& faults = lidar_outlet_.faults();
  if (const FaultConfig* fault = faults.active(FaultKind::kWrong, moment()))
    scale_ranges(scan, scenario_.robot.lidar, fault->share);
  if (faults.active(FaultKind::kGarbage, moment()) != nullptr) {
    Random random = garbage_random(Sensor::kLidar);
    make_garbage(scan, scenario_.robot.lidar, random);
  }
  scan.time += duration_from_seconds(scenario_.robot.lidar.late_s);
  lidar_outlet_.push(std::move(scan), moment());
}

Random Simulation::garbage_random(Sensor sensor) const {
  return Random{static_cast<std::uint64_t>(scenario_.run.seed), random_streams::kGarbage,
                static_cast<std::uint64_t>(sensor), static_cast<std::uint64_t>(step_)};
}

/// Measures a few beams of the sweep in every physics step. A finished sweep is stamped with the
/// time of its last beams (offsets of earlier beams are negative), so that stamps never go back.
void Simulation::measure_rolling_scan() {
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
  send_scan(sweep_);
}

cv::Mat Simulation::render_at(double later_s) {
  return renderer_.render(physics_.world_from_base_3d_at(later_s) *
                          camera_.config().base_from_camera());
}

/// The mean of kPicturesPerExposure pictures, spread over the exposure time centred on now(); blurs
/// by motion.
cv::Mat Simulation::render_exposure() {
  const double exposure_s = scenario_.camera_noise.exposure_s;
  if (exposure_s == 0.0) return render_at(0.0);
  cv::Mat sum;
  for (int i = 0; i < kPicturesPerExposure; ++i) {
    cv::Mat picture;
    render_at(exposure_s * ((i + 0.5) / kPicturesPerExposure - 0.5)).convertTo(picture, CV_16UC3);
    sum = i == 0 ? picture : cv::Mat{sum + picture};
  }
  cv::Mat mean;
  sum.convertTo(mean, CV_8UC3, 1.0 / kPicturesPerExposure);
  return mean;
}

CameraFrame Simulation::capture_frame() {
  const Faults& faults = camera_outlet_.faults();
  if (faults.active(FaultKind::kGarbage, moment()) != nullptr) {
    Random random = garbage_random(Sensor::kCamera);
    return camera_.compress(camera_.random_picture(random), now());
  }
  const FaultConfig* wrong = faults.active(FaultKind::kWrong, moment());
  const double light = wrong != nullptr ? 1.0 + wrong->share : 1.0;
  return camera_.compress(camera_.expose(render_exposure(), frames_taken_++, light), now());
}

Velocity Simulation::next_velocity() {
  const Kidnapper::RobotState robot = kidnapper_.update(moment(), physics_);
  if (robot == Kidnapper::RobotState::kHeld) return {};
  if (robot == Kidnapper::RobotState::kReleased) route_.begin_anew();
  if (scenario_.route.source == DriveSource::kCommand) return commands_.next(now());
  const Velocity velocity = route_.next(physics_.world_from_base());
  if (route_.arrived() && arrival_step_ == kNotYet) arrival_step_ = step_;
  return velocity;
}

void Simulation::check_progress() const {
  if (scenario_.route.source == DriveSource::kCommand || route_.arrived()) return;
  if (to_seconds(now()) < route_.time_limit_s()) return;
  const Se2 at = physics_.world_from_base();
  throw SimulatorError{fmt::format(
      "the robot has not arrived after {:.0f} s; it stands at ({:.2f}, {:.2f}), {:.2f} m from a "
      "wall or box; if none is in its way, set a larger route.duration_s",
      to_seconds(now()), at.x(), at.y(),
      clearance_m(world_.walls, world_.boxes, at.translation()))};
}

}  // namespace waymark
