// SPDX-License-Identifier: BSD-3-Clause
// Size of the mapped space, for the heading of map.png.
#pragma once

#include "common/corridor/corridor_length.hpp"
#include "common/geometry/se2.hpp"
#include "viewer/core/scene/grid_map.hpp"

#include <optional>
#include <string>

namespace waymark::viewer {

/// Extent of the free cells along x (length) and y (width) of the view frame.
struct FreeExtent {
  double length_m{0.0};
  double width_m{0.0};
};

/// Ignores rows and columns (of the view frame) with fewer than three free cells; nullopt if no row
/// or no column has three.
std::optional<FreeExtent> free_extent(const GridMap& map, const Se2& view_from_map,
                                      const MapThresholds& thresholds);

/// The length that waymark-evaluate measures on map.pgm; nullopt where the free space is no single
/// corridor.
std::optional<corridor::CorridorLength> corridor_length(const GridMap& map,
                                                        const MapThresholds& thresholds);

/// The corridor's length in metres and pixels; the extent of the free space if it is no
/// single corridor.
std::string size_text(const GridMap& map, const Se2& view_from_map,
                      const MapThresholds& thresholds);

}  // namespace waymark::viewer
