// SPDX-License-Identifier: BSD-3-Clause
// How the LiDAR moved, by its scans alone: what odometry and mounting are held against.
#pragma once

#include "import/log/imported_log.hpp"

#include <functional>
#include <vector>

namespace waymark {

/// From one scan to a later one, some decimetres or tens of degrees on.
struct LidarMotion {
  Timestamp from{};
  Timestamp to{};
  Se2 first_from_second{};  ///< LiDAR frame of the first scan
  bool is_complete{false};  ///< false: walls do not show one direction, only the turn is good
};

/// Turn between consecutive scans.
struct LidarTurn {
  Timestamp from{};
  Timestamp to{};
  double turn_rad{0.0};
};

struct LidarMotions {
  std::vector<LidarMotion> motions{};
  std::vector<LidarTurn> turns{};
  std::size_t num_lost{0};  ///< scans that did not fit the one they were laid over
};

using ShowProgress = std::function<void(double)>;

/// Each scan is registered with an earlier one, which is replaced by it every 0.3 m or 20 degrees.
/// Odometry is not used; a mirrored or turned LiDAR gives mirrored or turned motions.
LidarMotions lidar_motions(const ImportedLog& log, const ShowProgress& progress = {});

}  // namespace waymark
