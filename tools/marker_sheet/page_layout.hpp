// SPDX-License-Identifier: BSD-3-Clause
// Layout of sheets and pages. Millimetres, from the top left corner.
#pragma once

#include "marker_sheet/pattern.hpp"

#include <string>

namespace waymark::marker_sheet {

struct PageSize {
  double width_mm{};
  double height_mm{};
};

/// Upright page of that name: A4, A3 or Letter.
/// @throws std::runtime_error for any other name.
PageSize page_of(const std::string& name);

/// A pattern with its white border, caption and ruler, before it is put on pages.
struct SheetLayout {
  double width_mm{};
  double height_mm{};
  double pattern_width_mm{};
  double pattern_height_mm{};
  double pattern_x_mm{};  ///< top left corner of the pattern
  double pattern_y_mm{};
  double quiet_mm{};      ///< width of the white border
  double caption_y_mm{};  ///< top of the caption
  double ruler_x_mm{};    ///< left end of the ruler
  double ruler_y_mm{};    ///< line of the ruler
};

inline constexpr double kRuler_mm = 100.0;
inline constexpr double kCaption_mm = 5.0;  ///< height of the text
inline constexpr double kTick_mm = 4.0;     ///< length of the ruler's and the mounting ticks

SheetLayout layout_of(const Pattern& pattern);

/// How a sheet is spread over pages, which are cut at their margins and joined edge to edge.
struct Tiling {
  PageSize page{};  ///< portrait or landscape
  int columns{1};
  int rows{1};
  double cell_width_mm{};  ///< width of a page without its margins
  double cell_height_mm{};
  double offset_x_mm{};  ///< place of the sheet in the first cell: centred if one page is enough
  double offset_y_mm{};
};

inline constexpr double kMargin_mm = 10.0;  ///< printers cannot print closer to the edge

/// Portrait or landscape, whichever needs fewer pages; portrait if both need the same number.
/// @throws std::runtime_error if the page is unknown, if one page does not suffice and `tiles` is
/// false, or if more than 100 would be needed.
Tiling tiling_of(const SheetLayout& sheet, const std::string& page, bool tiles);

}  // namespace waymark::marker_sheet
