// SPDX-License-Identifier: BSD-3-Clause
// How thick the walls of a map are: what is drawn twice in two places, or smeared, is thick.
#pragma once

#include "evaluate/files/map_image.hpp"

namespace waymark::evaluate {

/// Side of the largest square of cells that fits into a wall [cells], but for the thickest 0.5 % of
/// the wall's cells; gaps of up to three cells between two walls count as wall, so that a wall that
/// stands there twice is thick. Corners and crossings of thin walls are thin. 0 without any wall.
int wall_thickness_cells(const MapImage& map);

}  // namespace waymark::evaluate
