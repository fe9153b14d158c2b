// SPDX-License-Identifier: BSD-3-Clause
// marker_layer.png: which marker id each cell carries.
#pragma once

#include "viewer/core/page/style.hpp"
#include "viewer/core/scene/grid_map.hpp"
#include "viewer/core/scene/scene.hpp"

#include <string>
#include <vector>

namespace waymark::viewer {

/// Neighbouring cells of one id as a landmark: in their middle, facing the open space nearby. Lone
/// cells, which the rim of a marker leaves, are left out. Sorted by id.
std::vector<Landmark> landmarks_of_cells(const GridMap& map);

/// Cells in a colour per id, each group of cells with its id beside it, over a faint map; folded
/// like map.png.
/// @return BGR.
cv::Mat paint_marker_layer(const GridMap& map, const std::string& title, const MapPageStyle& style);

}  // namespace waymark::viewer
