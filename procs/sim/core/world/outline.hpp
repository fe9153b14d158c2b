// SPDX-License-Identifier: BSD-3-Clause
// Where the walls stand: corridors and what opens from them, as closed lines around the free space.
#pragma once

#include "common/geometry/se2.hpp"
#include "sim/core/world/world_config.hpp"

#include <Eigen/Core>

#include <cstddef>
#include <optional>
#include <vector>

namespace waymark {

/// Begins at the inner face of the wall behind it, runs along x, its side walls at +-width / 2.
struct Corridor {
  Se2 world_from_corridor{};
  double length_m{0.0};
};

enum class WallKind { kSide, kEnd, kDoor };

/// Inner face from one point to another, seen from the free space with `from` on the right hand:
/// the wall's body lies to the right of from -> to.
struct Wall {
  WallKind kind{WallKind::kSide};
  Eigen::Vector2d from_m{0.0, 0.0};
  Eigen::Vector2d to_m{0.0, 0.0};
  double height_m{0.0};
  double thickness_m{0.0};
  double beyond_from_m{0.0};  ///< the body is longer than the face, to close corners from outside
  double beyond_to_m{0.0};

  double length_m() const { return (to_m - from_m).norm(); }

  Eigen::Vector2d along() const { return (to_m - from_m).normalized(); }

  /// Direction out of the free space.
  Eigen::Vector2d outward() const { return {along().y(), -along().x()}; }
};

/// The corridors in the order in which a route through the layout meets them.
std::vector<Corridor> corridors(const WorldConfig& world);

/// All walls; consecutive ones of a closed line share a point, the free space is on their left.
std::vector<Wall> outline(const WorldConfig& world);

/// The first opening for which there is no wall, or not enough of it, at its centre.
std::optional<std::size_t> opening_without_wall(const WorldConfig& world);

/// True when two walls cross, so that there is no inside: e.g. two rooms in the same place.
bool walls_cross(const std::vector<Wall>& walls);

/// Distance from a point to the nearest wall face; negative outside of the free space.
double clearance_m(const std::vector<Wall>& walls, const Eigen::Vector2d& point_m);

}  // namespace waymark
