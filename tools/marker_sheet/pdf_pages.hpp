// SPDX-License-Identifier: BSD-3-Clause
// Draws markers and boards at true size: as pages of a PDF, or as an image.
#pragma once

#include "marker_sheet/page_layout.hpp"

#include <string>
#include <vector>

namespace waymark::marker_sheet {

struct PageOptions {
  std::string page{"A4"};
  bool tiles{false};  ///< a pattern may be spread over several pages
};

struct Pdf {
  std::string bytes{};
  int num_pages{0};
};

/// One page per pattern, or one per tile, row by row. The same input gives the same bytes.
/// @throws std::runtime_error as tiling_of().
Pdf draw_pdf(const std::vector<Pattern>& patterns, const PageOptions& options);

/// An image with caption and ruler. Edges within a pixel are grey (anti-aliased), so that their
/// position is exact.
/// @throws std::runtime_error if the resolution is too coarse, or there would be too many pixels.
Sheet draw_picture(const Pattern& pattern, double dpi);

}  // namespace waymark::marker_sheet
