// SPDX-License-Identifier: BSD-3-Clause
// Finds places for markers on the walls of a map.
#pragma once

#include "placement/drive.hpp"
#include "placement/occupied_walls.hpp"

#include <span>
#include <string>
#include <vector>

namespace waymark::placement {

struct WallPlace {
  Se2 map_from_marker{};  ///< on the wall's line; x axis = normal, away from the wall
  double travel_m{0.0};   ///< length of the path where the drive passes the place
  std::string wall{};     ///< as seen from the passing robot: "left", "right", "ahead", "behind"
};

/// Straight pieces of wall as wide as a plate that the LiDAR saw during the drive and that have no
/// marker, one every `spacing_m` along each wall, in the order of the drive.
/// @param hung     map_from_marker of the existing markers.
/// @param plate_m  side of a marker with its quiet zone.
/// @param range_m  longest range of the LiDAR.
std::vector<WallPlace> free_wall_places(std::span<const Step> steps, const OccupiedWalls& walls,
                                        std::span<const Se2> hung, double plate_m, double range_m,
                                        double spacing_m);

/// Whether plates at both poses would be on the same side of a wall and overlap.
bool overlap(const Se2& a, const Se2& b, double plate_m);

}  // namespace waymark::placement
