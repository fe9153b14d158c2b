// SPDX-License-Identifier: BSD-3-Clause
// Finds the end walls of a corridor, from the inside along its middle.
#pragma once

#include "common/corridor/map_image.hpp"

#include <Eigen/Core>

#include <map>

namespace waymark::corridor {

/// Direction in which one end is looked for; distances are measured from `origin_px` along
/// `outward`. Strip r, one pixel wide and parallel to `outward`, holds the cells whose centres are
/// within half a pixel of r along `across`.
struct EndView {
  Eigen::Vector2d origin_px{};
  Eigen::Vector2d outward{};
  Eigen::Vector2d across{};
  double begin_px{};  ///< the search begins here, inside the corridor
};

struct CorridorEnd {
  bool has_wall{};
  /// Distance of the centre of the end wall's innermost cell, by central strip, if it has one.
  std::map<int, double> wall_px{};
  double median_wall_px{};
  double free_extent_px{};  ///< distance of the outer edge of the free space
};

/// The end wall is the innermost line of occupied cells that covers two fifths of the central
/// strips (the middle two thirds of the width), is tilted at most 20 degrees, and lies at most one
/// corridor width before and about half a width behind the end of the free space. So false cells
/// inside the corridor and holes in the wall do not matter.
CorridorEnd find_corridor_end(const MapImage& map, const EndView& view, double width_px);

}  // namespace waymark::corridor
