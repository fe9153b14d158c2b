// SPDX-License-Identifier: BSD-3-Clause
// Where on the walls of a map a marker could hang.
#pragma once

#include "placement/drive.hpp"
#include "placement/occupied_walls.hpp"

#include <span>
#include <string>
#include <vector>

namespace waymark::placement {

struct WallPlace {
  Se2 map_from_marker{};  ///< on the wall's line; heading = away from the wall
  double travel_m{0.0};   ///< of the drive, where it passes
  std::string wall{};     ///< as one drives past: "left", "right", "ahead", "behind"
};

/// Straight pieces of wall that the LiDAR saw on the drive, as wide as a plate, free of other
/// markers, one every `spacing_m` of each wall, in order of the drive.
/// @param plate_m  side of a marker with its quiet zone.
std::vector<WallPlace> free_wall_places(std::span<const Step> steps, const OccupiedWalls& walls,
                                        std::span<const Se2> hung, double plate_m, double range_m,
                                        double spacing_m);

/// Plates there would overlap, or hide each other.
bool overlap(const Se2& a, const Se2& b, double plate_m);

}  // namespace waymark::placement
