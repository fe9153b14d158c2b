// SPDX-License-Identifier: BSD-3-Clause
// The simulated robot in its world, tick by tick.
#pragma once

#include "common/random/random.hpp"
#include "common/sensors/sensors.hpp"
#include "sim/core/camera/camera.hpp"
#include "sim/core/camera/renderer.hpp"
#include "sim/core/faults/corruption.hpp"
#include "sim/core/faults/faulty_outlet.hpp"
#include "sim/core/robot/drive.hpp"
#include "sim/core/robot/physics.hpp"
#include "sim/core/scenario.hpp"
#include "sim/core/scene_dynamics.hpp"
#include "sim/core/sensors/encoders.hpp"
#include "sim/core/sensors/lidar.hpp"
#include "sim/core/timed_events.hpp"
#include "sim/core/world/world.hpp"

#include <cstdint>
#include <vector>

namespace waymark {

struct TruePose {
  Timestamp time{};
  Se2 world_from_base{};
};

/// Measurements with stamps from the end of the previous tick (inclusive) to `end` (exclusive), and
/// the markers moved at the start of this tick.
struct Tick {
  Timestamp end{};
  std::vector<OdometrySample> odometry{};
  std::vector<TruePose> true_poses{};
  std::vector<LidarScan> scans{};
  std::vector<CameraFrame> frames{};
  std::vector<MovedMarker> moved_markers{};
};

/// Deterministic: scenario and stamped commands determine every value, if every command is received
/// in time (CommandOutcome::kInTime).
class Simulation {
 public:
  /// @param scenario  one that Scenario::check() accepts.
  /// @throws SimulatorError when MuJoCo or OSMesa cannot be used.
  explicit Simulation(const Scenario& scenario);

  /// Simulates the next tick. @throws SimulatorError when the robot does not arrive in time.
  Tick advance();

  /// A velocity command (route.source = command only).
  CommandOutcome command(Timestamp stamp, const Velocity& velocity);

  /// True when the robot arrived at the end of the route at least route.settle_s ago; with
  /// route.source = command, when route.duration_s is over.
  bool finished() const;

  Timestamp now() const { return time_of_step(step_); }

  const World& world() const { return world_; }

  Se2 world_from_base() const { return physics_.world_from_base(); }

  /// Events of the scenario that have not begun.
  const std::vector<TimedEvent>& pending_events() const { return pending_events_.events(); }

  /// Share of the route driven so far, or, with route.source = command, of route.duration_s; 1 when
  /// finished.
  double progress_fraction() const;

 private:
  Timestamp time_of_step(std::int64_t step) const;
  bool is_due(double rate_hz) const;
  Moment moment() const;
  Random garbage_random(Sensor sensor) const;
  void measure(Tick& tick);
  void measure_odometry();
  void measure_rolling_scan();
  void send_scan(LidarScan scan);
  CameraFrame capture_frame();
  cv::Mat render_at(double later_s);
  cv::Mat render_exposure();
  Velocity next_velocity();
  void check_progress() const;

  Scenario scenario_;
  World world_;
  Camera camera_;
  Physics physics_;
  RouteFollower route_;
  CommandFollower commands_;
  WheelOdometry wheel_odometry_;
  Lidar lidar_;
  Renderer renderer_;
  SceneDynamics scene_dynamics_;
  Kidnapper kidnapper_;
  PendingEvents pending_events_;
  SpinningWheels spinning_wheels_{};
  FaultyOutlet<OdometrySample> odometry_outlet_;
  FaultyOutlet<LidarScan> lidar_outlet_;
  FaultyOutlet<CameraFrame> camera_outlet_;
  std::int64_t step_{0};
  std::int64_t arrival_step_{-1};
  std::uint64_t frames_taken_{0};
  LidarScan sweep_{};  ///< the unfinished sweep of a rolling scan
};

}  // namespace waymark
