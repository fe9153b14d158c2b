// SPDX-License-Identifier: BSD-3-Clause
// Reader of CARMEN logs (.clf, .log; plain, gzip or bzip2).
#pragma once

#include "common/errors/setup_error.hpp"
#include "import/carmen/carmen_line.hpp"
#include "import/carmen/odometry_lines.hpp"
#include "import/carmen/stamps.hpp"
#include "import/log/imported_log.hpp"

#include <filesystem>
#include <optional>

namespace waymark {

struct CarmenOptions {
  CarmenLidar lidar{CarmenLidar::kFront};
  std::optional<CarmenOdometrySource> odometry{};  ///< nullopt = see choose_odometry()
  CarmenBeams beams{};
  CarmenUnits units{};
  std::optional<double> scan_period_s{};  ///< for lines without times
  std::optional<CarmenStamps> stamps{};   ///< nullopt = see choose_stamps()
  std::optional<double> range_max_m{};    ///< nullopt = see mark_no_returns(); default: SICK LMS
  double range_min_m{0.0};
  double range_unit_m{1.0};  ///< of the lines' ranges, and of plausible maximum ranges
  LidarMounting mounting{};
};

/// No line of the file begins with a keyword of CARMEN's loggers: it is a file of another kind.
class NotACarmenLog : public SetupError {
 public:
  using SetupError::SetupError;
};

/// @throws SetupError when the file is unreadable, empty, or gives no scan or no odometry;
/// NotACarmenLog when it is a file of another kind.
ImportedLog read_carmen_log(const std::filesystem::path& file, const CarmenOptions& options,
                            ImportReport& report);

}  // namespace waymark
