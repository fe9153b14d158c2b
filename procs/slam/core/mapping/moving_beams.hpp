// SPDX-License-Identifier: BSD-3-Clause
// Beams that end on what moves.
#pragma once

#include "common/geometry/se2.hpp"
#include "slam/core/grid/grid_map.hpp"

#include <Eigen/Core>

#include <vector>

namespace waymark {

/// Ends of beams without those that lie where the map is free, wherever about the expected pose the
/// robot is: people who walk along would hold the matches back. Where most of a scan is so, it is
/// the pose that is wrong, and all of them stay.
///
/// @param covariance  of map_from_base: (x, y, theta), map's axes.
std::vector<Eigen::Vector2d> without_moving(const std::vector<Eigen::Vector2d>& points_in_base,
                                            const GridMap& map, const Se2& map_from_base,
                                            const Eigen::Matrix3d& covariance);

}  // namespace waymark
