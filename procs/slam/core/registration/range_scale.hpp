// SPDX-License-Identifier: BSD-3-Clause
// Scale of a LiDAR's ranges relative to a map.
#pragma once

#include "common/geometry/se2.hpp"
#include "slam/core/registration/ndt_map.hpp"
#include "slam/core/registration/range_noise.hpp"

#include <Eigen/Core>

#include <span>

namespace waymark {

struct RangeScale {
  double share{0.0};  ///< by which the ranges are longer than in the map, relative
  double sigma{0.0};  ///< its standard deviation
};

/// Fits the scale of ranges together with the pose; it is observable by walls on opposite sides.
/// @param origin_in_base    of the beams.
/// @param guess             map_from_base.
/// @param guess_covariance  of (x, y, theta), map's axes.
RangeScale fit_range_scale(std::span<const Eigen::Vector2d> points_in_base,
                           const Eigen::Vector2d& origin_in_base, const NdtMap& map,
                           const Se2& guess, const Eigen::Matrix3d& guess_covariance,
                           const RangeNoise& noise);

}  // namespace waymark
