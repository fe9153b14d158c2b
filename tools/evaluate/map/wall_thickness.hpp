// SPDX-License-Identifier: BSD-3-Clause
// Thickness of the walls of a map: walls that are blurred, or drawn twice side by side, are thick.
#pragma once

#include "evaluate/files/map_image.hpp"

namespace waymark::evaluate {

/// Side of the largest square of cells that fits into a wall [cells], ignoring the thickest 0.5 %
/// of the wall cells. Gaps of up to three cells between walls count as wall, so that a wall drawn
/// twice is thick. Corners and crossings of thin walls are thin. At most 20; 0
/// without any wall.
int wall_thickness_cells(const MapImage& map);

}  // namespace waymark::evaluate
