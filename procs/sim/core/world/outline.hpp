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

/// A wall, given by its inner face from_m -> to_m: the free space lies to the left of that line,
/// the solid wall to its right.
struct Wall {
  WallKind kind{WallKind::kSide};
  Eigen::Vector2d from_m{0.0, 0.0};
  Eigen::Vector2d to_m{0.0, 0.0};
  double height_m{0.0};
  double thickness_m{0.0};
  double beyond_from_m{0.0};  ///< length of solid wall beyond from_m, which closes the corner
  double beyond_to_m{0.0};    ///< the same beyond to_m

  double length_m() const { return (to_m - from_m).norm(); }

  Eigen::Vector2d along() const { return (to_m - from_m).normalized(); }

  /// Unit normal of the face, out of the free space.
  Eigen::Vector2d outward() const { return {along().y(), -along().x()}; }
};

/// The corridors in the order in which a route through the layout meets them.
std::vector<Corridor> corridors(const WorldConfig& world);

/// All walls; consecutive walls of a closed line share a point.
std::vector<Wall> outline(const WorldConfig& world);

/// Index of the first opening whose corridor does not exist, or has no wall wide enough at the
/// opening's centre; nullopt if every opening fits.
std::optional<std::size_t> opening_without_wall(const WorldConfig& world);

/// True when two walls cross or overlap, e.g. those of two rooms in the same place.
bool walls_cross(const std::vector<Wall>& walls);

/// A place where the solid part of a wall reaches into free space behind it, e.g. into a recess
/// that is nearer than a wall's thickness to the next one; nullopt if there is none.
std::optional<Eigen::Vector2d> solid_in_free_space(const std::vector<Wall>& walls);

/// Distance from a point to the nearest wall face; negative outside the free space.
double clearance_m(const std::vector<Wall>& walls, const Eigen::Vector2d& point_m);

}  // namespace waymark
