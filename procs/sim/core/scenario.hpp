// SPDX-License-Identifier: BSD-3-Clause
// A scenario: the complete configuration of a simulated run. Scenario and build determine every
// byte.
#pragma once

#include "common/config/config.hpp"
#include "common/expect/expect_config.hpp"
#include "common/robot/robot_config.hpp"
#include "sim/core/camera/camera.hpp"
#include "sim/core/faults/fault_config.hpp"
#include "sim/core/robot/drive.hpp"
#include "sim/core/scene_dynamics.hpp"
#include "sim/core/sensors/encoders.hpp"
#include "sim/core/sensors/lidar.hpp"
#include "sim/core/world/marker_picture.hpp"
#include "sim/core/world/world.hpp"

#include <cstdint>
#include <string>
#include <vector>

namespace waymark {

/// Time steps, seed, and participants of the lockstep.
struct RunConfig {
  std::int64_t seed{1};
  double tick_s{0.1};
  int physics_rate_hz{600};  ///< the default is divisible by 30, 10 and 5 Hz
  bool rolling_scan{false};
  std::vector<std::string> participants{"detector", "slam", "viewer", "recorder"};
  int window_ticks{4};

  static constexpr int kMaxWindowTicks = 100;

  void describe(Fields& fields);
};

/// Default of [robot]: its sigmas of camera and markers suit the simulation, where only rendering
/// and detection cause errors (0.02 px). A scenario with [camera_errors] has to set larger sigmas.
RobotConfig simulated_robot();

struct Scenario {
  RobotConfig robot{simulated_robot()};
  WorldConfig world{};
  MarkerLayoutConfig markers{};
  RouteConfig route{};
  OdometryErrorConfig odometry_errors{};
  LidarNoiseConfig lidar_noise{};
  CameraNoiseConfig camera_noise{};
  CameraErrorConfig camera_errors{};
  RunConfig run{};
  std::vector<FaultConfig> faults{};
  std::vector<KidnapConfig> kidnaps{};
  ExpectConfig expect{};  ///< used by waymark-evaluate only

  MarkerPrint marker_print() const {
    return {robot.markers.dictionary, robot.markers.size_m, markers.quiet_zone_modules};
  }

  /// Physics steps between two measurements of a sensor that measures at rate_hz.
  int steps_per(double rate_hz) const;
  int steps_per_tick() const;

  void describe(Fields& fields);
  void check(Problems& problems) const;

 private:
  void check_world(Problems& problems) const;
  void check_markers(Problems& problems) const;
  void check_places(Problems& problems) const;
  void check_added(const World& built, int num_ids, Problems& problems) const;
  void check_moves(const World& built, Problems& problems) const;
  /// Clearance that the robot needs where it drives straight on [m].
  double driving_clearance_m() const;
  void check_odometry(Problems& problems) const;
  void check_route(Problems& problems) const;
  void check_events(Problems& problems) const;
  void check_faults(Problems& problems) const;
  void check_times(Problems& problems) const;
};

}  // namespace waymark
