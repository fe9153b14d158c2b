// SPDX-License-Identifier: BSD-3-Clause
// Where a CARMEN log says that its LiDAR sits.
#pragma once

#include "import/carmen/carmen_line.hpp"

#include <span>
#include <vector>

namespace waymark {

/// The difference between LiDAR and odometry poses when it is the same in (nearly) all lines, else
/// what the PARAM lines say, else the origin. Where the lines say nothing (both poses are equal, as
/// in logs that were rewritten), or contradict the parameters, the report says what was taken.
/// @param base_from_lidar  of each scan's line; not empty
/// @param parameters       in the order of the log, of both LiDARs
Se2 find_mounting(std::span<const Se2> base_from_lidar,
                  const std::vector<CarmenMounting>& parameters, CarmenLidar lidar,
                  ImportReport& report);

}  // namespace waymark
