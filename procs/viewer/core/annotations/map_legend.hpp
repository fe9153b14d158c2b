// SPDX-License-Identifier: BSD-3-Clause
// The legend of map.png, with entries for what is on the map.
#pragma once

#include "viewer/core/layers/path_marks.hpp"
#include "viewer/core/page/map_page.hpp"

namespace waymark::viewer {

/// Writes entries from left to right, line by line.
/// @return the first row of the page below the legend.
int draw_legend(cv::Mat& page, const MapPage& layout, const PageContent& content,
                const UncertaintyMarks& marks);

}  // namespace waymark::viewer
