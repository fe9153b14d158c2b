// SPDX-License-Identifier: BSD-3-Clause
// Which directions of motion the walls in a scan can tell.
#pragma once

#include "slam/core/scan/annotated_scan.hpp"

#include <Eigen/Core>

#include <span>

namespace waymark {

/// Information that a scan's walls hold about the pose, if the map has them all.
struct Observability {
  /// [1/m^2, 1/(m rad), 1/rad^2] order x y theta, map frame.
  Eigen::Matrix3d information{Eigen::Matrix3d::Zero()};
  Eigen::Vector2d weak_direction{Eigen::Vector2d::Zero()};  ///< unit, map frame
  double weak_information{0.0};                             ///< [1/m^2] along weak_direction
  bool is_degenerate{true};  ///< walls all but silent about weak_direction
};

/// Each beam that lies on a smooth surface measures its distance along the surface's normal
/// (point-to-line; Censi 2007), with `range_sigma_m`.
Observability observability_of(std::span<const AnnotatedBeam> beams, const Se2& map_from_base,
                               double range_sigma_m);

}  // namespace waymark
