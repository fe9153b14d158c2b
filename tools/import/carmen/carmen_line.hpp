// SPDX-License-Identifier: BSD-3-Clause
// One line of a CARMEN log. The keywords that matter here, with their fields:
//   ODOM x y theta tv rv accel | ipc_timestamp ipc_hostname logger_timestamp
//   FLASER, RLASER n range*n laser_x laser_y laser_theta odom_x odom_y odom_theta | the same three
//   ROBOTLASER1, ROBOTLASER2 type start_angle field_of_view angular_resolution maximum_range
//     accuracy remission_mode n range*n n_remissions remission*n_remissions laser_x laser_y
//     laser_theta odom_x odom_y odom_theta laser_tv laser_rv forward_safety side_safety turn_axis
//     | the same three
//     Of the three that end a line, older loggers write no host, or ipc_timestamp alone, or none.
//   PARAM name value | the same three (only the LiDARs' mounting is used)
// FLASER and ROBOTLASER1 are the front LiDAR, RLASER and ROBOTLASER2 the rear one.
#pragma once

#include "common/geometry/se2.hpp"
#include "import/carmen/beam_angles.hpp"
#include "import/carmen/field_cursor.hpp"

#include <optional>
#include <string_view>
#include <variant>
#include <vector>

namespace waymark {

enum class CarmenLidar { kFront, kRear };

/// Beam angles given by the user, which override those of ROBOTLASER lines. FLASER and RLASER lines
/// have none; nullopt = as found by straightest_angles().
struct CarmenBeams {
  std::optional<double> first_angle_rad{};
  std::optional<double> angle_step_rad{};
};

/// Units of the numbers in a line, in seconds, metres and radians.
struct CarmenUnits {
  double time_s{1.0};
  double odometry_m{1.0};    ///< of the poses
  double odometry_rad{1.0};  ///< of their headings
};

struct CarmenScan {
  CarmenLidar lidar{CarmenLidar::kFront};
  double time_s{0.0};                   ///< ipc_timestamp
  double logger_time_s{0.0};            ///< finite, not validated
  std::size_t num_times{0};             ///< number of time fields in the line: 0 to 3
  std::vector<double> ranges_m{};       ///< as written; may be +inf; NaN for negative ones
  int num_no_ranges{0};                 ///< number of NaNs in ranges_m
  std::optional<BeamAngles> angles{};   ///< nullopt if the line has none
  std::optional<double> range_max_m{};  ///< nullopt if the line has none
  Se2 odom_from_lidar{};
  Se2 odom_from_base{};
  double heading_rad{0.0};  ///< of odom_from_base, as written
};

struct CarmenOdometry {
  double time_s{0.0};
  double logger_time_s{0.0};
  std::size_t num_times{0};
  Se2 odom_from_base{};
};

/// A line with one parameter of a LiDAR's mounting: an offset [m] or an angle [rad].
struct CarmenMounting {
  enum class What { kForward, kSideward, kAngle };

  CarmenLidar lidar{CarmenLidar::kFront};
  What what{What::kForward};
  double value{0.0};  ///< [m, m, rad] base frame
};

/// Any other line: comment, other parameter, another sensor.
struct CarmenOther {
  std::string_view keyword{"other lines"};  ///< keyword of a known sensor; static storage
};

using CarmenLine =
    std::variant<CarmenScan, CarmenOdometry, CarmenMounting, CarmenOther, LineProblem>;

/// Errors in the line give a LineProblem, never an exception. O(length).
CarmenLine parse_carmen_line(std::string_view line, const CarmenBeams& beams,
                             const CarmenUnits& units = {});

}  // namespace waymark
