// SPDX-License-Identifier: BSD-3-Clause
// The cells along a straight line.
#pragma once

#include "slam/core/grid/cell_index.hpp"

#include <cstdlib>

namespace waymark {

/// Calls visit(CellIndex) for every cell from `from` to `to`, both included: max(|dx|, |dy|) + 1
/// cells, each touching the next. Source: Bresenham (1965).
template <class Visit>
void visit_line(CellIndex from, CellIndex to, Visit&& visit) {
  const int dx = std::abs(to.x - from.x);
  const int dy = std::abs(to.y - from.y);
  const int step_x = from.x < to.x ? 1 : -1;
  const int step_y = from.y < to.y ? 1 : -1;
  int error = dx - dy;
  CellIndex cell = from;
  visit(cell);
  while (cell != to) {
    // Without branches: which of the two steps comes next cannot be predicted.
    const int along_x = 2 * error > -dy ? -1 : 0;
    const int along_y = 2 * error < dx ? -1 : 0;
    error += (along_y & dx) - (along_x & dy);
    cell.x += along_x & step_x;
    cell.y += along_y & step_y;
    visit(cell);
  }
}

}  // namespace waymark
