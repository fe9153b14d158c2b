// SPDX-License-Identifier: BSD-3-Clause
// Directions of motion that the walls in a scan observe.
#pragma once

#include "slam/core/scan/annotated_scan.hpp"

#include <Eigen/Core>

#include <optional>
#include <span>

namespace waymark {

/// Information about the pose in a scan's walls, if all of them are mapped.
struct Observability {
  /// [1/m^2, 1/(m rad), 1/rad^2] order x y theta, map frame.
  Eigen::Matrix3d information{Eigen::Matrix3d::Zero()};
  Eigen::Vector2d weak_direction{Eigen::Vector2d::Zero()};  ///< unit, map frame
  double weak_information{0.0};                             ///< [1/m^2] along weak_direction
  bool is_degenerate{true};  ///< the walls do not observe weak_direction

  /// `pose` with its deviation from `reference` along the weak direction removed, if there is one:
  /// scores at the result cannot pull a particle along a bare corridor.
  Se2 without_weak_part(const Se2& pose, const Se2& reference) const {
    if (!is_degenerate) return pose;
    const Eigen::Vector2d deviation = pose.translation() - reference.translation();
    return {Eigen::Vector2d{pose.translation() - weak_direction * weak_direction.dot(deviation)},
            pose.theta()};
  }
};

/// Unit normal of the surface around a beam's end, base frame, any sign; none at edges and on small
/// objects.
std::optional<Eigen::Vector2d> surface_normal(std::span<const AnnotatedBeam> beams, int beam);

/// Each beam that lies on a smooth surface measures its distance along the surface's normal
/// (point-to-line; Censi 2007), with `range_sigma_m`.
Observability observability_of(std::span<const AnnotatedBeam> beams, const Se2& map_from_base,
                               double range_sigma_m);

}  // namespace waymark
