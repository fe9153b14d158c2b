// SPDX-License-Identifier: BSD-3-Clause
// What is printed in black: of a marker, or of a ChArUco board. Millimetres, from the top left.
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
  double quiet_mm{};  ///< width of the white border around it
  std::vector<Rectangle> black{};
  std::string name{};     ///< short: on tiles
  std::string caption{};  ///< what it is and how large
};

/// @throws std::runtime_error if the options or the id make no marker.
Pattern marker_pattern(const SheetOptions& options, int id);

/// @throws SetupError if the options make no board.
Pattern board_pattern(const BoardOptions& options);

}  // namespace waymark::marker_sheet
