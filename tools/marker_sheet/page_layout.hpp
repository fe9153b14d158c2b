// SPDX-License-Identifier: BSD-3-Clause
// Where things go on paper. Millimetres, from the top left.
#pragma once

#include "marker_sheet/pattern.hpp"

#include <string>

namespace waymark::marker_sheet {

struct PageSize {
  double width_mm{};
  double height_mm{};
};

/// @throws std::runtime_error naming the known ones: A4, A3, Letter.
PageSize page_of(const std::string& name);

/// A pattern with its white border, caption and ruler, as if paper had no end.
struct SheetLayout {
  double width_mm{};
  double height_mm{};
  double pattern_width_mm{};
  double pattern_height_mm{};
  double pattern_x_mm{};  ///< its top left corner
  double pattern_y_mm{};
  double quiet_mm{};      ///< width of the white border
  double caption_y_mm{};  ///< top of the caption
  double ruler_x_mm{};    ///< left end of the ruler
  double ruler_y_mm{};    ///< its line
};

inline constexpr double kRuler_mm = 100.0;
inline constexpr double kCaption_mm = 5.0;  ///< height of its line
inline constexpr double kTick_mm = 4.0;     ///< of ruler and mounting height

SheetLayout layout_of(const Pattern& pattern);

/// How a sheet is spread over pages, which are cut at their margins and put edge to edge.
struct Tiling {
  PageSize page{};  ///< as it is turned: upright or lying
  int columns{1};
  int rows{1};
  double cell_width_mm{};  ///< of a page inside its margins
  double cell_height_mm{};
  double offset_x_mm{};  ///< of the sheet in the first cell: centred where one page is enough
  double offset_y_mm{};
};

inline constexpr double kMargin_mm = 10.0;  ///< printers leave that free

/// The turn of the page that needs fewer of them; upright where both need as many.
/// @throws std::runtime_error when one page is not enough and tiles are not wanted, or there would
/// be more than 100.
Tiling tiling_of(const SheetLayout& sheet, const std::string& page, bool tiles);

}  // namespace waymark::marker_sheet
