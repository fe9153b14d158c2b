// SPDX-License-Identifier: BSD-3-Clause
// Markers as pages of a PDF, at their true size.
#pragma once

#include "marker_sheet/page_layout.hpp"

#include <string>
#include <vector>

namespace waymark::marker_sheet {

struct PdfOptions {
  SheetOptions sheet{};  ///< the resolution does not matter
  std::string page{"A4"};
  bool tiles{false};  ///< markers may be spread over several pages
};

struct Pdf {
  std::string bytes{};
  int num_pages{0};
};

/// One page per marker, or one per tile, row by row. The same input gives the same bytes.
/// @throws std::runtime_error if the options or an id make no marker, or it does not fit the page.
Pdf draw_pdf(const PdfOptions& options, const std::vector<int>& ids);

}  // namespace waymark::marker_sheet
