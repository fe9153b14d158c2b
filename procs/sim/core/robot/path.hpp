// SPDX-License-Identifier: BSD-3-Clause
// A route as lines and arcs.
#pragma once

#include "common/geometry/se2.hpp"

#include <Eigen/Core>

#include <vector>

namespace waymark {

/// A straight line, or, with a curvature, an arc (positive: to the left).
struct PathPiece {
  Se2 world_from_start{};
  double length_m{0.0};
  double curvature_per_m{0.0};
  bool is_smooth_end{false};  ///< the next piece goes on in the same direction

  /// The pose on the piece at a distance from its start, heading along it.
  Se2 world_from(double along_m) const;
};

/// A robot's pose relative to a piece of path.
struct PathPlace {
  double along_m{0.0};
  double offset_m{0.0};  ///< to the left of the path
  double heading_error_rad{0.0};
};

PathPlace locate(const PathPiece& piece, const Se2& world_from_base);

/// Lines from point to point. With a radius above 0, corners become arcs of that radius, or of a
/// smaller radius where the adjoining lines are short; turns of more than 160 degrees stay sharp.
std::vector<PathPiece> path_through(const std::vector<Eigen::Vector2d>& points_m,
                                    double corner_radius_m);

}  // namespace waymark
