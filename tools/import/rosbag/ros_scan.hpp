// SPDX-License-Identifier: BSD-3-Clause
// LaserScan -> the messages of LIDAR.
#pragma once

#include "import/log/imported_log.hpp"
#include "import/rosbag/ros_messages.hpp"

#include <optional>

namespace waymark {

/// Angles of a LiDAR that hangs upside down run the other way round in the base frame.
enum class ScanPlane { kUpright, kUpsideDown };

/// A scan with a time increment keeps the time of each beam (lidar_t). Ranges as they are meant
/// (REP-117): +inf = no return, NaN = no measurement; below the shortest range, 0 included, there
/// is none.
/// @return nothing when the numbers are none that a LiDAR measures.
std::optional<ImportedScan> to_imported_scan(const RosScan& scan, Timestamp time, std::int64_t at,
                                             ScanPlane plane);

}  // namespace waymark
