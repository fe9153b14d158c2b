// SPDX-License-Identifier: BSD-3-Clause
// Converts LaserScan messages to messages of LIDAR.
#pragma once

#include "import/log/imported_log.hpp"
#include "import/rosbag/ros_messages.hpp"

#include <variant>

namespace waymark {

/// How the LiDAR is mounted. Upside down, its angles increase clockwise in the base frame.
enum class LidarOrientation { kUpright, kUpsideDown };

using RosScanResult = std::variant<ImportedScan, LineProblem>;

/// A scan with a time increment keeps the time of each beam (lidar_t); otherwise it becomes a
/// planar_lidar_t. Ranges follow REP-117: +inf = no return (also from range_max on), NaN = no
/// measurement (also below range_min, and 0).
/// @return a problem if the number of beams, angles or duration are impossible for a LiDAR.
RosScanResult to_imported_scan(const RosScan& scan, Timestamp time, std::int64_t at,
                               LidarOrientation orientation);

}  // namespace waymark
