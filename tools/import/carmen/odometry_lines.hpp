// SPDX-License-Identifier: BSD-3-Clause
// Which lines of a CARMEN log are taken where it has several: of two LiDARs, of two odometries.
#pragma once

#include "import/carmen/line_times.hpp"

#include <optional>
#include <vector>

namespace waymark {

/// Which lines the odometry comes from. Never from both: they are stamped by different processes,
/// and where they disagree by milliseconds the robot would seem to jump to and fro.
enum class CarmenOdometrySource {
  kLaserLines,  ///< the odometry pose in each scan's line: exact at the scan; what GMapping reads
  kOdomLines,   ///< ODOM
};

/// base_from_lidar, as each scan's line says.
std::vector<Se2> lidar_poses(const std::vector<ReadScan>& scans);

/// Two LiDARs whose lines have one keyword, as their places on the robot show: the one with more
/// scans stays (of equals, the first). Every time twice, with other ranges, is only named.
void keep_one_lidar(std::vector<ReadScan>& scans, ImportReport& report);

/// As wanted, else the scans' lines; where these never move and the ODOM lines do, these, which is
/// said.
CarmenOdometrySource choose_odometry(const std::vector<ReadScan>& scans,
                                     const std::vector<ReadOdometry>& odometry,
                                     std::optional<CarmenOdometrySource> wanted,
                                     ImportReport& report);

/// @throws SetupError when the headings of the scans' lines are degrees: the robot drives where
/// they point as degrees, and not as radians.
void check_headings(const std::vector<ReadScan>& scans);

}  // namespace waymark
