// SPDX-License-Identifier: BSD-3-Clause
// Chooses between the lines of two LiDARs, and between two kinds of odometry lines.
#pragma once

#include "import/carmen/line_times.hpp"

#include <optional>
#include <vector>

namespace waymark {

/// Which lines the odometry comes from. Never both: they are stamped by different processes, and
/// differences of milliseconds would make the robot seem to jump back and forth.
enum class CarmenOdometrySource {
  kLaserLines,  ///< the odometry pose in each scan's line: exact at the scan; what GMapping reads
  kOdomLines,   ///< ODOM
};

/// base_from_lidar of each scan's line.
std::vector<Se2> lidar_poses(const std::vector<ReadScan>& scans);

/// If the lines of one keyword are of two LiDARs, as two mounting poses show, keeps the one with
/// more scans (of equals, the first). Pairs of different scans with equal times are only reported.
void keep_one_lidar(std::vector<ReadScan>& scans, ImportReport& report);

/// The wanted source; else the scans' lines, or, if these never move and the ODOM lines do, the
/// ODOM lines, which is reported.
/// @throws SetupError when the ODOM lines are wanted, and there are none.
CarmenOdometrySource choose_odometry(const std::vector<ReadScan>& scans,
                                     const std::vector<ReadOdometry>& odometry,
                                     std::optional<CarmenOdometrySource> wanted,
                                     ImportReport& report);

/// @throws SetupError when the headings of the scans' lines are degrees: read as degrees they agree
/// with the direction of driving, read as radians they do not.
void check_headings(const std::vector<ReadScan>& scans);

}  // namespace waymark
