// SPDX-License-Identifier: BSD-3-Clause
// The world as geometry: walls, boxes and markers. World frame: origin on the floor, in the middle
// of the inner face of the first corridor's start wall; x along that corridor, y left, z up.
#pragma once

#include "sim/core/world/outline.hpp"
#include "sim/core/world/world_config.hpp"

#include <Eigen/Core>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace waymark {

/// A marker on a wall, world frame.
struct MarkerPlate {
  int id{0};
  int instance{0};                          ///< 0, 1, ... among the markers with the same id
  Eigen::Vector3d centre_m{0.0, 0.0, 0.0};  ///< centre of the black square, on the printed surface
  double yaw_rad{0.0};                      ///< direction that the marker faces
};

/// A marker that is moved during the run.
struct MarkerMove {
  std::size_t marker{0};  ///< index into World::markers
  Trigger when{};
  Eigen::Vector2d by_m{0.0, 0.0};
};

/// Walls form closed lines.
struct World {
  std::vector<Wall> walls{};
  std::vector<BoxConfig> boxes{};
  std::vector<MarkerPlate> markers{};  ///< at the start; ordered by place, added ones last
  std::vector<MarkerMove> moves{};
  double ceiling_height_m{0.0};
};

/// How far a marker's printed surface stands out from the wall (a sheet on a thin board).
constexpr double kPlateThickness_m = 0.002;

/// Builds walls and markers, without the markers that are missing by configuration or by the seed.
World build_world(const WorldConfig& world, const MarkerLayoutConfig& markers, double plate_size_m,
                  std::int64_t seed);

/// Number of places for markers in the layout, including those of missing markers. There is no
/// place where the wall does not cover the whole back of the plate (at a doorway or a junction).
std::size_t place_count(const WorldConfig& world, const MarkerLayoutConfig& markers,
                        double plate_size_m);

/// The marker ids in order of places: markers.ids, or its only element for every place, or, if it
/// is empty, consecutive ids from first_id on.
std::vector<int> marker_ids(const MarkerLayoutConfig& markers, std::size_t num_places);

/// The plate on a wall that is nearest to a point; sets centre x, y and yaw.
/// @return nullopt where no wall with room for it is within half a metre.
std::optional<MarkerPlate> plate_near(const std::vector<Wall>& walls,
                                      const Eigen::Vector2d& point_m, double plate_size_m);

/// Like clearance_m() of the walls alone (outline.hpp), but with boxes: distance from a point to
/// the nearest wall face or box; 0 inside a box, negative outside the walls.
double clearance_m(const std::vector<Wall>& walls, const std::vector<BoxConfig>& boxes,
                   const Eigen::Vector2d& point_m);

/// True when a wall covers the whole back of the plate.
bool hangs_on_a_wall(const std::vector<Wall>& walls, const Eigen::Vector2d& centre_m,
                     double plate_size_m);

}  // namespace waymark
