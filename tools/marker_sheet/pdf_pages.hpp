// SPDX-License-Identifier: BSD-3-Clause
// Markers and boards on paper, at their true size: pages of a PDF, or a picture.
#pragma once

#include "marker_sheet/page_layout.hpp"

#include <string>
#include <vector>

namespace waymark::marker_sheet {

struct PageOptions {
  std::string page{"A4"};
  bool tiles{false};  ///< patterns may be spread over several pages
};

struct Pdf {
  std::string bytes{};
  int num_pages{0};
};

/// One page per pattern, or one per tile, row by row. The same input gives the same bytes.
/// @throws std::runtime_error if a pattern does not fit the page.
Pdf draw_pdf(const std::vector<Pattern>& patterns, const PageOptions& options);

/// With caption and ruler. Edges between pixels are grey, so that they are where they belong.
/// @throws std::runtime_error if the resolution is too coarse, or there would be too many pixels.
Sheet draw_picture(const Pattern& pattern, double dpi);

}  // namespace waymark::marker_sheet
