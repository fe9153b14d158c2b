// SPDX-License-Identifier: BSD-3-Clause
// Excludes beams that end on moving objects.
#pragma once

#include "common/geometry/se2.hpp"
#include "slam/core/grid/grid_map.hpp"

#include <Eigen/Core>

#include <vector>

namespace waymark {

/// Removes points that lie in free space of the map for every pose within the covariance: people
/// who walk beside the robot would bias the match. If the removed points are most of the outline
/// that the scan shows, the pose is wrong, and all points are kept.
///
/// @param covariance  of map_from_base: (x, y, theta), map's axes.
std::vector<Eigen::Vector2d> without_moving(const std::vector<Eigen::Vector2d>& points_in_base,
                                            const GridMap& map, const Se2& map_from_base,
                                            const Eigen::Matrix3d& covariance);

}  // namespace waymark
