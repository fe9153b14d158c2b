// SPDX-License-Identifier: BSD-3-Clause
// The black areas of a marker or of a ChArUco board. Millimetres, from the top left corner.
#pragma once

#include "common/markers/charuco_board.hpp"
#include "marker_sheet/marker_sheet.hpp"

#include <string>
#include <vector>

namespace waymark::marker_sheet {

struct Rectangle {
  double x_mm{};
  double y_mm{};
  double width_mm{};
  double height_mm{};
};

struct Pattern {
  double width_mm{};
  double height_mm{};
  double quiet_mm{};  ///< width of the white border around the pattern
  std::vector<Rectangle> black{};
  std::string name{};     ///< short name, printed on tiles
  std::string caption{};  ///< dictionary, ids and size
};

/// @throws std::runtime_error if the options or the id are invalid.
Pattern marker_pattern(const SheetOptions& options, int id);

/// @throws SetupError if the options are invalid.
Pattern board_pattern(const BoardOptions& options);

}  // namespace waymark::marker_sheet
