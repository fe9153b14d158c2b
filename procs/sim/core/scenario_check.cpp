// SPDX-License-Identifier: BSD-3-Clause
// Checks of a scenario that concern several fields; scenario_route_check.cpp has those of the route
// and of what happens along it.
#include "sim/core/scenario.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

namespace waymark {
namespace {

constexpr double kPlateSlack_m = 1e-9;
constexpr double kSameWall_rad = 1e-6;
constexpr double kRobotLength_m = 0.30;

bool is_whole(double value) {
  return std::abs(value - std::round(value)) < 1e-9 * std::max(1.0, std::abs(value)) &&
         std::round(value) >= 1.0;
}

std::string not_in_dictionary(int id, const std::string& dictionary, int num_ids) {
  return fmt::format("marker id {} is not in {}, which has ids 0 to {}", id, dictionary,
                     num_ids - 1);
}

void check_fault(const FaultConfig& fault, const std::string& key, Problems& problems) {
  const auto demand = [&](FaultKind kind, bool is_good, const char* expected) {
    if (fault.kind == kind && !is_good) problems.add(key, expected);
  };
  const bool is_of_one_wheel = fault.sensor == Sensor::kOdometry && fault.kind == FaultKind::kWrong;
  if (fault.during.is_empty()) problems.add(key, "it ends before it begins");
  demand(FaultKind::kWrong, fault.share != 0.0, "wrong by a share of 0 is right; set share");
  demand(FaultKind::kIntermittent, fault.share > 0.0 && fault.share <= 1.0,
         "expected a share above 0 and up to 1");
  demand(FaultKind::kDelayed, fault.delay_s > 0.0, "expected a delay_s above 0");
  if (fault.wheel != Wheel::kBoth && !is_of_one_wheel)
    problems.add(key, "a wheel can only be named where the odometry is wrong");
}

}  // namespace

void Scenario::check(Problems& problems) const {
  robot.check(problems);
  check_world(problems);
  if (!problems.lines().empty()) return;  // the other checks need a valid world
  check_markers(problems);
  if (problems.lines().empty()) check_places(problems);
  check_odometry(problems);
  check_route(problems);
  check_events(problems);
  check_faults(problems);
  check_times(problems);
}

void Scenario::check_world(Problems& problems) const {
  const double least_m = world.layout == Layout::kStraight ? kRobotLength_m
                         : world.layout == Layout::kL      ? world.width_m + kRobotLength_m
                                                           : 2.0 * world.width_m + kRobotLength_m;
  const auto check_length = [&](const char* key, double length_m) {
    if (length_m >= least_m) return;
    problems.add(
        key, fmt::format("got {}, expected more than the robot's length{}, {} m", length_m,
                         world.layout == Layout::kStraight ? "" : " between the corners", least_m));
  };
  check_length("world.length_m", world.length_m);
  if (world.layout != Layout::kStraight)
    check_length("world.second_length_m", world.second_length_m);
  if (const double robot_m = 2.0 * driving_clearance_m(); world.width_m < robot_m) {
    problems.add("world.width_m", fmt::format("got {}, expected more than the robot's width, {} m",
                                              world.width_m, robot_m));
  }
  if (!problems.lines().empty()) return;
  if (const std::optional<std::size_t> opening = opening_without_wall(world)) {
    problems.add(fmt::format("world.openings[{}]", *opening),
                 "expected a wall of its corridor, wide enough, that no other opening has cut");
  } else if (walls_cross(outline(world))) {
    problems.add("world.openings",
                 "two of them are in the same place, or reach through a corridor");
  } else if (const auto at_m = solid_in_free_space(outline(world))) {
    problems.add("world.wall_thickness_m",
                 fmt::format("got {}, by which a wall reaches into the free space behind it, at "
                             "({:.2f}, {:.2f})",
                             world.wall_thickness_m, at_m->x(), at_m->y()));
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
  if (markers.layout == MarkerLayout::kNone && markers.added.empty()) return;
  const double half_plate_m = 0.5 * plate_size_m(marker_print());
  if (markers.centre_height_m < half_plate_m - kPlateSlack_m ||
      markers.centre_height_m > world.wall_height_m - half_plate_m + kPlateSlack_m) {
    problems.add("markers.centre_height_m",
                 fmt::format("got {}, expected a plate of {:.2f} m to fit between floor and wall "
                             "top, {} m",
                             markers.centre_height_m, 2.0 * half_plate_m, world.wall_height_m));
  }
  if (markers.layout == MarkerLayout::kNone) return;
  const bool ends_in_time = world.layout != Layout::kStraight ||
                            markers.last_m <= world.length_m - half_plate_m + kPlateSlack_m;
  if (markers.first_m < half_plate_m - kPlateSlack_m || markers.last_m < markers.first_m ||
      !ends_in_time) {
    problems.add("markers", fmt::format("first_m {} and last_m {} must lie in this order within "
                                        "the walls, from {:.2f} to {:.2f} m",
                                        markers.first_m, markers.last_m, half_plate_m,
                                        world.length_m - half_plate_m));
    return;
  }
  if (markers.spacing_m < 2.0 * half_plate_m - kPlateSlack_m) {
    problems.add("markers.spacing_m", fmt::format("got {}, expected at least the size of a plate, "
                                                  "{:.2f} m",
                                                  markers.spacing_m, 2.0 * half_plate_m));
  }
}

void Scenario::check_places(Problems& problems) const {
  const std::size_t num_places = place_count(world, markers, plate_size_m(marker_print()));
  if (markers.ids.size() > 1 && markers.ids.size() != num_places) {
    problems.add("markers.ids", fmt::format("got {} ids, expected one for each of the {} markers",
                                            markers.ids.size(), num_places));
    return;
  }
  const int num_ids = *dictionary_size(robot.markers.dictionary);
  for (const int id : marker_ids(markers, num_places)) {
    if (id < num_ids) continue;
    problems.add(markers.ids.empty() ? "markers.first_id" : "markers.ids",
                 not_in_dictionary(id, robot.markers.dictionary, num_ids));
    return;
  }
  for (const int number : markers.missing) {
    if (number < static_cast<int>(num_places)) continue;
    problems.add("markers.missing", fmt::format("there is no place {}, the last one is {}", number,
                                                static_cast<int>(num_places) - 1));
  }
  const World built = build_world(world, markers, plate_size_m(marker_print()), run.seed);
  check_added(built, num_ids, problems);
  check_moves(built, problems);
}

void Scenario::check_added(const World& built, int num_ids, Problems& problems) const {
  const double plate_m = plate_size_m(marker_print());
  for (std::size_t i = 0; i < markers.added.size(); ++i) {
    const MarkerAddConfig& added = markers.added[i];
    const std::string key = fmt::format("markers.added[{}]", i);
    if (added.id >= num_ids)
      problems.add(key, not_in_dictionary(added.id, robot.markers.dictionary, num_ids));
    const auto hung = plate_near(built.walls, {added.x_m, added.y_m}, plate_m);
    if (!hung) {
      problems.add(key, fmt::format("no wall with room for a plate of {:.2f} m is within half a "
                                    "metre of ({}, {})",
                                    plate_m, added.x_m, added.y_m));
      continue;
    }
    const auto is_in_its_way = [&](const MarkerPlate& other) {
      return std::abs(angle_difference(other.yaw_rad, hung->yaw_rad)) < kSameWall_rad &&
             (other.centre_m - hung->centre_m).head<2>().norm() < plate_m - kPlateSlack_m;
    };
    // The count includes the added marker itself.
    if (std::count_if(built.markers.begin(), built.markers.end(), is_in_its_way) > 1)
      problems.add(key, "another marker hangs there");
  }
}

void Scenario::check_moves(const World& built, Problems& problems) const {
  const double plate_m = plate_size_m(marker_print());
  if (built.moves.size() != markers.moved.size()) {
    problems.add("markers.moved", "one of the places has no marker that could be moved");
    return;
  }
  std::vector<MarkerPlate> now = built.markers;
  for (std::size_t i = 0; i < built.moves.size(); ++i) {
    const MarkerMove& move = built.moves[i];
    const std::string key = fmt::format("markers.moved[{}]", i);
    now[move.marker].centre_m.head<2>() += move.by_m;
    if (!hangs_on_a_wall(built.walls, now[move.marker].centre_m.head<2>(), plate_m))
      problems.add(key, "the marker would not hang on its wall any more");
    if (!move.when.is_set()) problems.add(key, "expected an at_s or at_m above 0");
  }
}

void Scenario::check_odometry(Problems& problems) const {
  if (!odometry_errors.draw_from_seed) return;
  for (const auto& [key, value] : {std::pair{"scale", odometry_errors.scale},
                                   std::pair{"heading_scale", odometry_errors.heading_scale}}) {
    if (value == 0.0) continue;
    problems.add(fmt::format("odometry_errors.{}", key),
                 fmt::format("got {}, which odometry_errors.draw_from_seed replaces: expected "
                             "draw_from_seed = false beside it",
                             value));
  }
}

void Scenario::check_faults(Problems& problems) const {
  for (std::size_t i = 0; i < faults.size(); ++i)
    check_fault(faults[i], fmt::format("faults[{}]", i), problems);
  for (std::size_t i = 0; i < world.boxes.size(); ++i)
    if (world.boxes[i].present.is_empty())
      problems.add(fmt::format("world.boxes[{}]", i), "it goes before it comes");
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
