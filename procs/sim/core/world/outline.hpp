// SPDX-License-Identifier: BSD-3-Clause
// The walls of corridors, recesses and rooms, as closed lines around the free space.
#pragma once

#include "common/geometry/se2.hpp"
#include "sim/core/world/world_config.hpp"

#include <Eigen/Core>

#include <cstddef>
#include <optional>
#include <vector>

namespace waymark {

/// A corridor in its own frame: from the inner face of its start wall along x, side walls at y =
/// +-width / 2.
struct Corridor {
  Se2 world_from_corridor{};
  double length_m{0.0};
};

enum class WallKind { kSide, kEnd, kDoor };

/// A wall by its inner face. Its body lies to the right of from -> to, the free space to the left.
struct Wall {
  WallKind kind{WallKind::kSide};
  Eigen::Vector2d from_m{0.0, 0.0};
  Eigen::Vector2d to_m{0.0, 0.0};
  double height_m{0.0};
  double thickness_m{0.0};
  double beyond_from_m{0.0};  ///< the body extends beyond the face, to close outer corners
  double beyond_to_m{0.0};

  double length_m() const { return (to_m - from_m).norm(); }

  Eigen::Vector2d along() const { return (to_m - from_m).normalized(); }

  /// Direction out of the free space.
  Eigen::Vector2d outward() const { return {along().y(), -along().x()}; }
};

/// The corridors in the order in which a route through the layout meets them.
std::vector<Corridor> corridors(const WorldConfig& world);

/// All walls; consecutive walls of a closed line share a point.
std::vector<Wall> outline(const WorldConfig& world);

/// Index of the first opening that does not fit into a wall at its centre.
std::optional<std::size_t> opening_without_wall(const WorldConfig& world);

/// True when two walls cross or overlap, e.g. those of two rooms in the same place.
bool walls_cross(const std::vector<Wall>& walls);

/// Distance from a point to the nearest wall face; negative outside the free space.
double clearance_m(const std::vector<Wall>& walls, const Eigen::Vector2d& point_m);

}  // namespace waymark
