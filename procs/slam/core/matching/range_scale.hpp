// SPDX-License-Identifier: BSD-3-Clause
// Whether a LiDAR measures all ranges too long or too short, as the walls of a map tell.
#pragma once

#include "slam/core/matching/surface_matching.hpp"

#include <Eigen/Core>

#include <optional>
#include <span>

namespace waymark {

/// Factor by which ranges are longer than the walls of the map say, less one.
struct RangeScale {
  double share{0.0};
  double sigma{0.0};
  double fitting{0.0};  ///< share of the mapped beams that fit when ranges are scaled by it

  /// More than a map can be off, and the scan is like the map in all else. Where the place has
  /// changed, or is another one, no scale fits.
  bool is_wrong() const;

  bool is_right() const;
};

/// Least squares for the pose and the scale, beams to lines.
/// @param map_from_base, uncertainty  where the robot should be, and covariance of that: without
/// it, one wall could not be told from another one that is further away.
/// @return nothing where too little of the scan is mapped.
std::optional<RangeScale> range_scale(std::span<const AnnotatedBeam> beams, SurfaceFinder& map,
                                      const Se2& map_from_base, const Eigen::Matrix3d& uncertainty,
                                      const SurfaceMatchingConfig& config);

}  // namespace waymark
