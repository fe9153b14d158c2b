// SPDX-License-Identifier: BSD-3-Clause
// marker_layer.png: the marker id of each cell.
#pragma once

#include "viewer/core/page/style.hpp"
#include "viewer/core/scene/grid_map.hpp"
#include "viewer/core/scene/scene.hpp"

#include <string>
#include <vector>

namespace waymark::viewer {

/// A landmark for each group of neighbouring cells of one id: in their middle, facing the open
/// space nearby. Single cells, as at the rim of a marker, are ignored. Sorted by id.
std::vector<Landmark> landmarks_of_cells(const GridMap& map);

/// Cells in the colour of their id over a faint map, each group labelled; folded like map.png.
/// @return BGR.
cv::Mat paint_marker_layer(const GridMap& map, const std::string& title, const MapPageStyle& style);

}  // namespace waymark::viewer
