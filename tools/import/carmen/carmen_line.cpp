// SPDX-License-Identifier: BSD-3-Clause
#include "import/carmen/carmen_line.hpp"

#include "common/messages/bounds.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

namespace waymark {
namespace {

constexpr int kMaxBeams = 4000;            // limit of robot.lidar.num_beams
constexpr double kLatestTime_s = 4e9;      // the year 2096
constexpr double kLargestMounting = 10.0;  // [m, rad]

// Keywords of CARMEN's loggers whose lines are not used here.
constexpr std::array<std::string_view, 27> kOtherKeywords{
    "ROBOTLASER3", "ROBOTLASER4",      "ROBOTLASER5",   "ARM",       "SYNC",      "TRUEPOS",
    "RAWLASER1",   "RAWLASER2",        "RAWLASER3",     "RAWLASER4", "RAWLASER5", "LASER3",
    "LASER4",      "LASER5",           "ROBOTVELOCITY", "POSITION",  "MARKER",    "SCANMARK",
    "NMEAGGA",     "NMEARMC",          "SONAR",         "BUMPER",    "IMU",       "IMU_CORR",
    "PANTILT",     "FOLLOWTRAJECTORY", "BASEVELOCITY"};

/// Options of the user that apply to all lines.
struct Given {
  const CarmenBeams& beams;
  const CarmenUnits& units;
};

Se2 read_pose(FieldCursor& fields, std::string_view name, const CarmenUnits& units,
              double* heading_rad = nullptr) {
  const double x_m = fields.number(name) * units.odometry_m;
  const double y_m = fields.number(name) * units.odometry_m;
  const double theta_rad = fields.number(name) * units.odometry_rad;
  if (heading_rad != nullptr) *heading_rad = theta_rad;
  if (std::max(std::abs(x_m), std::abs(y_m)) > bounds::kPosition_m ||
      std::abs(theta_rad) > bounds::kAngle_rad) {
    fields.fail("number out of range",
                fmt::format("{} is ({}, {}, {})", name, x_m, y_m, theta_rad));
  }
  return {x_m, y_m, theta_rad};
}

/// Negative ranges become NaN and are counted, like NaN.
void read_ranges(FieldCursor& fields, int num_beams, CarmenScan& scan) {
  scan.ranges_m.reserve(static_cast<std::size_t>(num_beams));
  for (int i = 0; i < num_beams && !fields.failed(); ++i) {
    const double range_m = fields.any_number(fmt::format("range {} of {}", i, num_beams));
    const bool is_none = std::isnan(range_m) || range_m < 0.0;
    if (is_none) ++scan.num_no_ranges;
    scan.ranges_m.push_back(is_none ? std::numeric_limits<double>::quiet_NaN() : range_m);
  }
}

constexpr std::size_t kAllTimes = 3;

/// Reads the three fields that end every line, or the fewer ones of older loggers; checks that
/// nothing follows.
template <class Line>
void read_times(FieldCursor& fields, const CarmenUnits& units, Line& line) {
  line.num_times = std::min(fields.num_left(), kAllTimes);
  if (line.num_times == 0) return;
  const bool has_host = line.num_times == kAllTimes || !fields.ends_with_number();
  line.time_s = fields.number("ipc_timestamp") * units.time_s;
  if (line.num_times > 1) {
    if (has_host) fields.word("ipc_hostname");
    line.logger_time_s = fields.number("logger_timestamp") * units.time_s;
  }
  fields.expect_end();
  if (line.time_s < 0.0 || line.time_s > kLatestTime_s) {
    fields.fail("bad time", fmt::format("ipc_timestamp is {}{}", line.time_s,
                                        line.time_s > kLatestTime_s
                                            ? " s, a year after 2096: are times in ms or us? Give "
                                              "--time-unit ms or us"
                                            : ""));
  }
  // A wrong logger_timestamp is no error: it is only used if ipc_timestamp is unusable.
  line.logger_time_s = std::clamp(line.logger_time_s, 0.0, kLatestTime_s);
}

CarmenLine finish(FieldCursor& fields, CarmenLine line) {
  if (fields.failed()) return *fields.problem();
  return line;
}

CarmenLine parse_odometry(FieldCursor& fields, const CarmenUnits& units) {
  CarmenOdometry odometry{};
  odometry.odom_from_base = read_pose(fields, "the odometry pose", units);
  for (const std::string_view name : {"tv", "rv", "accel"})
    fields.number(name);
  read_times(fields, units, odometry);
  return finish(fields, odometry);
}

void read_poses(FieldCursor& fields, const CarmenUnits& units, CarmenScan& scan) {
  scan.odom_from_lidar = read_pose(fields, "the LiDAR pose", units);
  scan.odom_from_base = read_pose(fields, "the odometry pose", units, &scan.heading_rad);
}

CarmenLine parse_old_laser(FieldCursor& fields, CarmenLidar lidar, const Given& given) {
  CarmenScan scan{};
  scan.lidar = lidar;
  const int num_beams = fields.integer("the number of ranges", 1, kMaxBeams);
  read_ranges(fields, num_beams, scan);
  read_poses(fields, given.units, scan);
  read_times(fields, given.units, scan);
  return finish(fields, scan);
}

/// Angular step: the header's resolution; if that is 0, field of view / (number of beams - 1).
double angle_step(FieldCursor& fields, double field_of_view_rad, double resolution_rad,
                  int num_beams) {
  const double gaps = std::max(1, num_beams - 1);
  if (resolution_rad == 0.0) return field_of_view_rad / gaps;
  // The last beam is at the end of the field of view, or one step before.
  constexpr double kRounding = 0.02;  // start angle and resolution are written with six digits
  const bool agrees = resolution_rad > 0.0 &&
                      resolution_rad * gaps <= field_of_view_rad * (1.0 + kRounding) &&
                      resolution_rad * (gaps + 1.0) >= field_of_view_rad * (1.0 - kRounding);
  if (!agrees) {
    fields.fail("contradictory header",
                fmt::format("{} beams of {} rad do not make a field of view of {} rad: give "
                            "--first-angle-deg and --angle-step-deg",
                            num_beams, resolution_rad, field_of_view_rad));
  }
  return resolution_rad;
}

CarmenLine parse_robot_laser(FieldCursor& fields, CarmenLidar lidar, const Given& given) {
  CarmenScan scan{};
  scan.lidar = lidar;
  fields.number("laser_type");
  BeamAngles& angles = scan.angles.emplace();
  angles.first_rad = fields.number("start_angle");
  const double field_of_view_rad = fields.number("field_of_view");
  const double resolution_rad = fields.number("angular_resolution");
  scan.range_max_m = fields.number("maximum_range");
  fields.number("accuracy");
  fields.number("remission_mode");
  const int num_beams = fields.integer("the number of ranges", 1, kMaxBeams);
  read_ranges(fields, num_beams, scan);
  const int num_remissions = fields.integer("the number of remissions", 0, kMaxBeams);
  for (int i = 0; i < num_remissions && !fields.failed(); ++i)
    fields.number("a remission");
  read_poses(fields, given.units, scan);
  for (const std::string_view name : {"tv", "rv", "forward_safety", "side_safety", "turn_axis"})
    fields.number(name);
  read_times(fields, given.units, scan);
  angles.first_rad = given.beams.first_angle_rad.value_or(angles.first_rad);
  if (given.beams.angle_step_rad) {
    angles.step_rad = *given.beams.angle_step_rad;
    if (*scan.range_max_m <= 0.0) scan.range_max_m.reset();
    return finish(fields, scan);
  }
  constexpr double kTurn_rad = 2.0 * std::numbers::pi;
  if (std::abs(angles.first_rad) > kTurn_rad || field_of_view_rad <= 0.0 ||
      field_of_view_rad > 1.01 * kTurn_rad || *scan.range_max_m <= 0.0) {
    fields.fail("contradictory header",
                fmt::format("start angle {} rad, field of view {} rad, maximum range {} m: give "
                            "--first-angle-deg and --angle-step-deg",
                            angles.first_rad, field_of_view_rad, *scan.range_max_m));
  }
  angles.step_rad = angle_step(fields, field_of_view_rad, resolution_rad, num_beams);
  return finish(fields, scan);
}

/// Parses the parameters of the LiDARs' mounting; all others are CarmenOther.
CarmenLine parse_parameter(FieldCursor& fields) {
  using What = CarmenMounting::What;
  constexpr std::array<std::pair<std::string_view, What>, 3> kMountings{
      {{"_offset", What::kForward},
       {"_side_offset", What::kSideward},
       {"_angular_offset", What::kAngle}}};
  constexpr std::string_view kFront = "robot_frontlaser";
  constexpr std::string_view kRear = "robot_rearlaser";
  const std::string_view name = fields.word("the parameter's name");
  const bool is_front = name.starts_with(kFront);
  if (!is_front && !name.starts_with(kRear)) return CarmenOther{};
  const std::string_view what = name.substr(is_front ? kFront.size() : kRear.size());
  const auto known =
      std::ranges::find(kMountings, what, [](const auto& entry) { return entry.first; });
  if (known == kMountings.end()) return CarmenOther{};
  const CarmenMounting mounting{is_front ? CarmenLidar::kFront : CarmenLidar::kRear, known->second,
                                fields.number(name)};
  if (std::abs(mounting.value) > kLargestMounting) {
    fields.fail("number out of range", fmt::format("{} is {}", name, mounting.value));
  }
  return finish(fields, mounting);
}

}  // namespace

CarmenLine parse_carmen_line(std::string_view line, const CarmenBeams& beams,
                             const CarmenUnits& units) {
  const std::size_t start = line.find_first_not_of(" \t\r");
  if (start == std::string_view::npos || line[start] == '#') return CarmenOther{};
  FieldCursor fields{line};
  const Given given{beams, units};
  const std::string_view keyword = fields.word("the keyword");
  if (keyword == "PARAM") return parse_parameter(fields);
  if (keyword == "ODOM") return parse_odometry(fields, units);
  if (keyword == "FLASER") return parse_old_laser(fields, CarmenLidar::kFront, given);
  if (keyword == "RLASER") return parse_old_laser(fields, CarmenLidar::kRear, given);
  if (keyword == "ROBOTLASER1") return parse_robot_laser(fields, CarmenLidar::kFront, given);
  if (keyword == "ROBOTLASER2") return parse_robot_laser(fields, CarmenLidar::kRear, given);
  const auto other = std::ranges::find(kOtherKeywords, keyword);
  if (other != kOtherKeywords.end()) return CarmenOther{*other};
  return LineProblem{"unknown line", quoted(keyword) + " is no keyword of a CARMEN log"};
}

}  // namespace waymark
