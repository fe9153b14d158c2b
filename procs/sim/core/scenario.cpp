// SPDX-License-Identifier: BSD-3-Clause
#include "sim/core/scenario.hpp"

#include <fmt/format.h>

#include <cmath>
#include <set>

namespace waymark {
namespace {

constexpr double kRoundingSlack_m = 1e-9;
// Half of the Waffle Pi's length and width with some air: closest approach of the base to a wall.
constexpr double kBodyBehind_m = 0.20;
constexpr double kBodyAhead_m = 0.10;
constexpr double kBodyBeside_m = 0.16;
constexpr double kRobotLength_m = 0.30;

bool is_whole(double value) {
  return std::abs(value - std::round(value)) < 1e-9 * std::max(1.0, std::abs(value)) &&
         std::round(value) >= 1.0;
}

}  // namespace

void RunConfig::describe(Fields& fields) {
  fields.field("seed", seed, {0, 1e15}, "of all randomness");
  fields.field("tick_s", tick_s, {0.01, 10.0}, "simulated time between two TICK messages");
  fields.field("physics_rate_hz", physics_rate_hz, {100, 10000}, "physics steps per second");
  fields.field("rolling_scan", rolling_scan,
               "LIDAR as lidar_t, each beam measured at its own time; else planar_lidar_t");
  fields.field("participants", participants,
               "processes that acknowledge every tick; each waits for those before it");
  fields.field("window_ticks", window_ticks, {1, 100}, "ticks in flight at most");
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
  fields.section("run", run);
  fields.section("route", route);
  fields.section("expect", expect);
}

void Scenario::check(Problems& problems) const {
  robot.check(problems);
  check_world(problems);
  if (!problems.lines().empty()) return;  // nothing fits into a world that is too small
  check_markers(problems);
  check_route(problems);
  check_times(problems);
}

void Scenario::check_world(Problems& problems) const {
  if (world.length_m < kRobotLength_m) {
    problems.add("world.length_m",
                 fmt::format("got {}, expected more than the robot's length, {} m", world.length_m,
                             kRobotLength_m));
  }
  if (world.width_m < 2.0 * kBodyBeside_m) {
    problems.add("world.width_m", fmt::format("got {}, expected more than the robot's width, {} m",
                                              world.width_m, 2.0 * kBodyBeside_m));
  }
}

void Scenario::check_markers(Problems& problems) const {
  const std::optional<int> num_ids = dictionary_size(robot.markers.dictionary);
  if (!num_ids) {
    problems.add("robot.markers.dictionary",
                 fmt::format("got '{}', expected a predefined dictionary of OpenCV, e.g. "
                             "DICT_6X6_250",
                             robot.markers.dictionary));
    return;
  }
  if (markers.layout == MarkerLayout::kNone) return;
  const double half_plate_m = 0.5 * plate_size_m(marker_print());
  if (markers.first_m < half_plate_m - kRoundingSlack_m || markers.last_m < markers.first_m ||
      markers.last_m > world.length_m - half_plate_m + kRoundingSlack_m) {
    problems.add("markers", fmt::format("first_m {} and last_m {} must lie in this order within "
                                        "the walls, from {:.2f} to {:.2f} m",
                                        markers.first_m, markers.last_m, half_plate_m,
                                        world.length_m - half_plate_m));
    return;
  }
  if (markers.spacing_m < 2.0 * half_plate_m - kRoundingSlack_m) {
    problems.add("markers.spacing_m", fmt::format("got {}, expected at least the size of a plate, "
                                                  "{:.2f} m",
                                                  markers.spacing_m, 2.0 * half_plate_m));
  }
  if (markers.centre_height_m < half_plate_m - kRoundingSlack_m ||
      markers.centre_height_m > world.wall_height_m - half_plate_m + kRoundingSlack_m) {
    problems.add("markers.centre_height_m",
                 fmt::format("got {}, expected a plate of {:.2f} m to fit between floor and wall "
                             "top, {} m",
                             markers.centre_height_m, 2.0 * half_plate_m, world.wall_height_m));
  }
  if (!markers.ids.empty() && markers.ids.size() != marker_count(markers)) {
    problems.add("markers.ids", fmt::format("got {} ids, expected one for each of the {} markers",
                                            markers.ids.size(), marker_count(markers)));
    return;
  }
  for (const int id : marker_ids(markers)) {
    if (id < *num_ids) continue;
    problems.add(markers.ids.empty() ? "markers.first_id" : "markers.ids",
                 fmt::format("marker id {} is not in {}, which has ids 0 to {}", id,
                             robot.markers.dictionary, *num_ids - 1));
    return;
  }
}

void Scenario::check_route(Problems& problems) const {
  const auto check_inside = [&](const char* key, double x_m, double y_m, double behind_m) {
    const double half_free_m = 0.5 * world.width_m - kBodyBeside_m;
    if (x_m >= behind_m && x_m <= world.length_m - kBodyAhead_m && std::abs(y_m) <= half_free_m) {
      return;
    }
    problems.add(key, fmt::format("({}, {}) is inside a wall or too close to one: free are x {} to "
                                  "{:.2f} m, y {:.2f} to {:.2f} m",
                                  x_m, y_m, behind_m, world.length_m - kBodyAhead_m, -half_free_m,
                                  half_free_m));
  };
  check_inside("route.start", route.start_x_m, route.start_y_m, kBodyBehind_m);
  if (route.source == DriveSource::kCommand) {
    if (route.duration_s <= 0.0) {
      problems.add("route.duration_s", "expected a number above 0 when commands drive");
    }
    if (route.command_delay_ticks <= run.window_ticks) {
      problems.add("route.command_delay_ticks",
                   fmt::format("got {}, expected more than run.window_ticks, {}: the next ticks "
                               "have been simulated when a command arrives",
                               route.command_delay_ticks, run.window_ticks));
    }
    return;
  }
  const char* key = route.waypoints.empty() ? "route.end_x_m" : "route.waypoints";
  for (const Eigen::Vector2d& point : route.points())
    check_inside(key, point.x(), point.y(), kBodyAhead_m);
}

void Scenario::check_times(Problems& problems) const {
  const auto check_rate = [&](const char* key, double rate_hz) {
    if (!is_whole(run.physics_rate_hz / rate_hz)) {
      problems.add(key, fmt::format("got {}, expected a divisor of run.physics_rate_hz, {}",
                                    rate_hz, run.physics_rate_hz));
    }
  };
  check_rate("robot.base.odometry_rate_hz", robot.base.odometry_rate_hz);
  check_rate("robot.lidar.rate_hz", robot.lidar.rate_hz);
  check_rate("robot.camera.rate_hz", robot.camera.rate_hz);
  if (!is_whole(run.physics_rate_hz * run.tick_s)) {
    problems.add("run.tick_s", fmt::format("got {}, expected a whole number of physics steps of "
                                           "1/{} s",
                                           run.tick_s, run.physics_rate_hz));
  }
  const std::set<std::string> distinct(run.participants.begin(), run.participants.end());
  if (distinct.size() != run.participants.size()) {
    problems.add("run.participants", "a name is listed twice");
  }
}

}  // namespace waymark
