// SPDX-License-Identifier: BSD-3-Clause
// The world as plain geometry: walls and markers. Frame "world": x along the corridor from the
// inner face of the start wall, y to the left from the middle, z up from the floor.
#pragma once

#include "common/config/config.hpp"

#include <Eigen/Core>

#include <cstddef>
#include <vector>

namespace waymark {

/// A corridor; lengths between inner faces.
struct WorldConfig {
  double length_m{50.0};
  double width_m{2.0};
  double wall_height_m{2.4};
  double wall_thickness_m{0.1};

  void describe(Fields& fields);
};

enum class MarkerLayout { kOpposite, kStaggered, kNone };

/// Where the markers hang. What they look like is RobotConfig's: the robot has to know that.
struct MarkerLayoutConfig {
  MarkerLayout layout{MarkerLayout::kOpposite};
  double first_m{4.0};
  double spacing_m{4.0};
  double last_m{48.0};
  double centre_height_m{0.3};
  double quiet_zone_modules{2.0};  ///< one module confuses OpenCV 4.6 (it keeps the ring's edge)
  bool blank{false};
  int first_id{0};
  std::vector<int> ids{};

  void describe(Fields& fields);
};

enum class WallKind { kSide, kEnd };

/// Inner face from one point to another, seen from the free space with `from` on the right hand:
/// the wall's body lies to the right of from -> to.
struct Wall {
  WallKind kind{WallKind::kSide};
  Eigen::Vector2d from_m{0.0, 0.0};
  Eigen::Vector2d to_m{0.0, 0.0};
  double height_m{0.0};
  double thickness_m{0.0};
};

/// Centre of the black square, on the visible surface; yaw = the direction that the marker faces.
struct MarkerPlate {
  int id{0};
  int instance{0};  ///< counts the markers with the same id
  Eigen::Vector3d centre_m{0.0, 0.0, 0.0};
  double yaw_rad{0.0};
};

/// A closed world; another layout is another function that fills this.
struct World {
  std::vector<Wall> walls{};
  std::vector<MarkerPlate> markers{};  ///< in order of station, left wall before right wall
  double ceiling_height_m{0.0};
};

/// How far a marker's printed surface stands out from the wall (a sheet on a thin board).
constexpr double kPlateThickness_m = 0.002;

/// A straight corridor with end walls.
World straight_corridor(const WorldConfig& world, const MarkerLayoutConfig& markers);

/// Number of markers that the layout has.
std::size_t marker_count(const MarkerLayoutConfig& markers);

/// Id of each marker, in order: the explicit list, or counted up from first_id.
std::vector<int> marker_ids(const MarkerLayoutConfig& markers);

}  // namespace waymark
