// SPDX-License-Identifier: BSD-3-Clause
// The map in the format of ROS's map_server: an image (map.pgm) and its description (map.yaml).
#pragma once

#include "viewer/core/scene/grid_map.hpp"

#include <string>
#include <string_view>

namespace waymark::viewer {

/// Binary grey image, one pixel per cell, highest y first: 0 = occupied, 254 = free, 205 = unknown.
/// An empty map becomes one unknown pixel.
std::string pgm_text(const GridMap& map, const MapThresholds& thresholds);

/// map.yaml: origin (lower left corner of the lower left pixel, map frame), resolution, thresholds.
std::string map_yaml_text(const GridMap& map, const MapThresholds& thresholds,
                          std::string_view image_name);

}  // namespace waymark::viewer
