// SPDX-License-Identifier: BSD-3-Clause
// Scale of a LiDAR's ranges, relative to the map's.
#pragma once

#include "common/geometry/se2.hpp"
#include "slam/core/registration/ndt_map.hpp"
#include "slam/core/registration/range_noise.hpp"

#include <Eigen/Core>

#include <span>

namespace waymark {

/// By which share ranges are longer than the map says.
struct RangeScale {
  double share{0.0};
  double sigma{0.0};
};

/// Fits the scale of ranges together with the pose; walls on opposite sides observe it.
/// @param origin_in_base    of the beams.
/// @param guess             map_from_base.
/// @param guess_covariance  of (x, y, theta), map's axes.
RangeScale fit_range_scale(std::span<const Eigen::Vector2d> points_in_base,
                           const Eigen::Vector2d& origin_in_base, const NdtMap& map,
                           const Se2& guess, const Eigen::Matrix3d& guess_covariance,
                           const RangeNoise& noise);

}  // namespace waymark
