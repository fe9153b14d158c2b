// SPDX-License-Identifier: BSD-3-Clause
// The rigid motion in the plane between two sets of points.
#pragma once

#include "common/geometry/se2.hpp"

#include <Eigen/Core>

#include <vector>

namespace waymark {

/// One point in two frames.
struct PointPair {
  Eigen::Vector2d target{Eigen::Vector2d::Zero()};
  Eigen::Vector2d source{Eigen::Vector2d::Zero()};
};

/// target_from_source with the least sum of squared distances. O(pairs).
/// Source: Umeyama 1991, in the plane and without scale.
/// @param pairs  not empty; the rotation of a single one is 0.
Se2 rigid_fit(const std::vector<PointPair>& pairs);

}  // namespace waymark
