// SPDX-License-Identifier: BSD-3-Clause
// Checks of a scenario's route and of what happens along it.
#include "sim/core/robot/path.hpp"
#include "sim/core/scenario.hpp"
#include "sim/core/timed_events.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace waymark {
namespace {

constexpr double kRoundingSlack_m = 1e-9;
// Smallest distance of the base frame's origin to a wall, from the Waffle Pi's size.
constexpr double kTurningClearance_m = 0.20;  // turning on the spot: its length behind the base
constexpr double kDrivingClearance_m = 0.16;  // driving straight on: half of its width
constexpr double kBesideWheels_m = kDrivingClearance_m - 0.5 * BaseConfig{}.wheel_separation_m;
constexpr double kTurns_rad = 0.02;  // smaller turns on the spot need no more clearance
constexpr double kRouteSample_m = 0.05;

/// Empty if the point is at least `needed_m` away from every wall and every box, even one that is
/// there only for a time; else a sentence about the problem.
std::string what_is_too_close(const std::vector<Wall>& walls, const std::vector<BoxConfig>& boxes,
                              const Eigen::Vector2d& point_m, double needed_m) {
  const double nearest_m = clearance_m(walls, boxes, point_m);
  if (nearest_m >= needed_m - kRoundingSlack_m) return {};
  const std::string place = clearance_m(walls, point_m) < 0.0
                                ? "outside of the walls"
                                : fmt::format("{:.2f} m from a wall or box", nearest_m);
  return fmt::format("({:.2f}, {:.2f}) is {}, expected {:.2f} m of room on all sides", point_m.x(),
                     point_m.y(), place, needed_m);
}

}  // namespace

double Scenario::driving_clearance_m() const {
  return std::max(kDrivingClearance_m, 0.5 * robot.base.wheel_separation_m + kBesideWheels_m);
}

void Scenario::check_route(Problems& problems) const {
  const std::vector<Wall> walls = outline(world);
  const auto check_free = [&](const std::string& key, const Eigen::Vector2d& point_m,
                              double needed_m) {
    const std::string problem = what_is_too_close(walls, world.boxes, point_m, needed_m);
    if (!problem.empty()) problems.add(key, problem);
    return problem.empty();
  };
  const double driving_m = driving_clearance_m();
  const double turning_m = std::max(kTurningClearance_m, driving_m);
  check_free("route.start", {route.start_x_m, route.start_y_m}, turning_m);
  for (std::size_t i = 0; i < kidnaps.size(); ++i) {
    const std::string key = fmt::format("kidnaps[{}]", i);
    check_free(key, {kidnaps[i].to_x_m, kidnaps[i].to_y_m}, turning_m);
    if (!kidnaps[i].when.is_set()) problems.add(key, "expected an at_s or at_m above 0");
  }
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
  if (route.waypoints.empty() && route.laps > 1)
    problems.add("route.laps", "expected waypoints that lead back to the start");
  double heading_rad = route.start_yaw_rad;
  for (const PathPiece& piece : path_through(route.corners(), route.corner_radius_m)) {
    const Se2& start = piece.world_from_start;
    const bool turns = std::abs(angle_difference(start.theta(), heading_rad)) > kTurns_rad;
    if (turns && !check_free(key, start.translation(), turning_m)) return;  // one is enough
    const int num_samples = 1 + static_cast<int>(piece.length_m / kRouteSample_m);
    for (int i = 0; i <= num_samples; ++i) {
      const Se2 world_from_base = piece.world_from(i * piece.length_m / num_samples);
      if (!check_free(key, world_from_base.translation(), driving_m)) return;
    }
    heading_rad = piece.world_from(piece.length_m).theta();
  }
}

/// Checks events whose times can never come. Whether the others happen shows at the end of the run:
/// see PendingEvents.
void Scenario::check_events(Problems& problems) const {
  if (route.source != DriveSource::kCommand) return;
  for (const auto& [key, during] : timed_events(*this)) {
    if (during.from_m > 0.0 || during.to_m < kNever)
      problems.add(key,
                   "is set by distance along the route, but route.source = command has no "
                   "route: expected times");
  }
}

}  // namespace waymark
