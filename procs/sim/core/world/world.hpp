// SPDX-License-Identifier: BSD-3-Clause
// The world as plain geometry: walls, boxes and markers. Frame "world": x along the first corridor
// from the inner face of its start wall, y to the left from its middle, z up from the floor.
#pragma once

#include "sim/core/world/outline.hpp"
#include "sim/core/world/world_config.hpp"

#include <Eigen/Core>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace waymark {

/// Centre of the black square, on the visible surface; yaw = the direction that the marker faces.
struct MarkerPlate {
  int id{0};
  int instance{0};  ///< counts the markers with the same id
  Eigen::Vector3d centre_m{0.0, 0.0, 0.0};
  double yaw_rad{0.0};
};

/// A marker that is hung elsewhere during the run.
struct MarkerMove {
  std::size_t marker{0};  ///< index into World::markers
  Trigger when{};
  Eigen::Vector2d by_m{0.0, 0.0};
};

/// A closed world.
struct World {
  std::vector<Wall> walls{};
  std::vector<BoxConfig> boxes{};
  std::vector<MarkerPlate> markers{};  ///< as at the beginning, in order of their places
  std::vector<MarkerMove> moves{};
  double ceiling_height_m{0.0};
};

/// How far a marker's printed surface stands out from the wall (a sheet on a thin board).
constexpr double kPlateThickness_m = 0.002;

/// Builds the walls and hangs the markers, those that the seed has spared.
World build_world(const WorldConfig& world, const MarkerLayoutConfig& markers, double plate_size_m,
                  std::int64_t seed);

/// Number of places where the layout has a marker, missing ones included. Where there is no wall
/// behind the whole plate (a doorway, a junction), there is no place.
std::size_t place_count(const WorldConfig& world, const MarkerLayoutConfig& markers,
                        double plate_size_m);

/// Id of each of so many places: the explicit list, the one for all, or counted up from first_id.
std::vector<int> marker_ids(const MarkerLayoutConfig& markers, std::size_t num_places);

/// Nearest centre of a plate on a wall, and the direction that it faces.
/// @return nullopt where no wall with room for it is within half a metre.
std::optional<MarkerPlate> plate_near(const std::vector<Wall>& walls,
                                      const Eigen::Vector2d& point_m, double plate_size_m);

/// Is there wall behind a whole plate?
bool hangs_on_a_wall(const std::vector<Wall>& walls, const Eigen::Vector2d& centre_m,
                     double plate_size_m);

}  // namespace waymark
