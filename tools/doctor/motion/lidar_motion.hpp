// SPDX-License-Identifier: BSD-3-Clause
// Motion of the LiDAR from its scans alone, the reference for odometry and mounting.
#pragma once

#include "import/log/imported_log.hpp"

#include <functional>
#include <vector>

namespace waymark {

/// Motion from one scan to a later one, some decimetres or tens of degrees on.
struct LidarMotion {
  Timestamp from{};
  Timestamp to{};
  Se2 first_from_second{};  ///< LiDAR frame of the first scan
  bool is_complete{false};  ///< false: the walls do not observe one direction; the turn is valid
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
  std::size_t num_lost{0};  ///< scans that could not be registered
};

using ShowProgress = std::function<void(double)>;

/// Registers each scan with a reference scan, which is replaced every 0.3 m or 20 degrees. Odometry
/// is not used; a mirrored or rotated LiDAR gives mirrored or rotated motions.
LidarMotions lidar_motions(const ImportedLog& log, const ShowProgress& progress = {});

}  // namespace waymark
