// SPDX-License-Identifier: BSD-3-Clause
// The LiDAR's mounting in a CARMEN log.
#pragma once

#include "import/carmen/carmen_line.hpp"

#include <span>
#include <vector>

namespace waymark {

/// The LiDAR's pose relative to odometry's if it is the same in nearly all lines and not the
/// identity (as in rewritten logs); else that of the PARAM lines; else the origin. The second and
/// third case, and contradictions, are reported.
/// @param base_from_lidar  of each scan's line; not empty.
/// @param parameters       of both LiDARs, in the order of the log.
Se2 find_mounting(std::span<const Se2> base_from_lidar,
                  const std::vector<CarmenMounting>& parameters, CarmenLidar lidar,
                  ImportReport& report);

}  // namespace waymark
