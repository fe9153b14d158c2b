// SPDX-License-Identifier: BSD-3-Clause
// The line through the middle of a corridor's free space.
#pragma once

#include "common/corridor/map_image.hpp"

#include <Eigen/Core>

#include <vector>

namespace waymark::corridor {

/// Cell centres [px] of the largest connected free region (cells that share a side).
std::vector<Eigen::Vector2d> largest_free_region(const MapImage& map);

struct Axis {
  Eigen::Vector2d centre_px{};
  Eigen::Vector2d direction{};  ///< unit; towards the map's +x, or +y if the axis is nearer to y
};

/// Mean of the points, and direction of their largest spread. @param points at least two.
Axis principal_axis(const std::vector<Eigen::Vector2d>& points);

/// Points ordered along the corridor in the principal axis' direction, equally spaced, smooth. The
/// line starts and ends where the corridor still has its full width, so a little before the walls.
struct MedialLine {
  std::vector<Eigen::Vector2d> points_px{};
  double spacing_px{};
  double width_px{};  ///< median width of the free space
};

/// Slices the free space across its principal axis, then twice across the line found so far; slices
/// of unusual width (doors, holes, ends) are outliers. Works while the corridor turns less than
/// about 60 degrees away from its principal axis.
/// @throws NotACorridor if the region is too small or too irregular to have such a line.
MedialLine medial_line(const MapImage& map, const std::vector<Eigen::Vector2d>& region);

}  // namespace waymark::corridor
