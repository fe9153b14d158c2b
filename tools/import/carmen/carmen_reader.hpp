// SPDX-License-Identifier: BSD-3-Clause
// A CARMEN log (.clf, .log; gzip, bzip2 or not) -> scans and odometry.
#pragma once

#include "import/carmen/carmen_line.hpp"
#include "import/carmen/odometry_lines.hpp"
#include "import/carmen/stamps.hpp"
#include "import/log/imported_log.hpp"

#include <filesystem>
#include <optional>

namespace waymark {

struct CarmenOptions {
  CarmenLidar lidar{CarmenLidar::kFront};
  std::optional<CarmenOdometrySource> odometry{};  ///< nullopt = the scans' lines, if they move
  CarmenBeams beams{};
  CarmenUnits units{};
  std::optional<double> scan_period_s{};  ///< of lines without times
  std::optional<CarmenStamps> stamps{};   ///< nullopt = ipc_timestamp if it advances
  std::optional<double> range_max_m{};    ///< nullopt = see mark_no_returns(); usual: SICK LMS
  double range_min_m{0.0};
  double range_unit_m{1.0};  ///< of the lines' ranges
  LidarMounting mounting{};
};

/// @throws SetupError when the file is unreadable, empty, or gives no scan or no odometry.
ImportedLog read_carmen_log(const std::filesystem::path& file, const CarmenOptions& options,
                            ImportReport& report);

}  // namespace waymark
