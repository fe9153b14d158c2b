// SPDX-License-Identifier: BSD-3-Clause
// What stands around the map on map.png: heading, scale bar, rulers.
#pragma once

#include "viewer/core/page/map_page.hpp"

#include <optional>
#include <string>

namespace waymark::viewer {

/// Extent of the free cells in the view frame [m].
struct FreeExtent {
  double length_m{0.0};
  double width_m{0.0};
  double length_px{0.0};  ///< the same in cells, as the paper counts
};

/// Longest run from the first to the last column (row) of the view with free cells; nullopt
/// without any. A few stray cells do not count.
std::optional<FreeExtent> free_extent(const GridMap& map, const Se2& view_from_map);

/// Title; what the map measures; in which health the path was, and what its weak axes rest on.
void draw_heading(cv::Mat& page, const cv::Rect& area_px, const std::string& title,
                  const PageContent& content, const Se2& view_from_map);

/// Metre ticks below a strip.
void draw_ruler(cv::Mat& page, const Panel& panel);

/// Frames of the strips in the overview, with their letters.
void draw_strip_marks(cv::Mat& page, const MapPage& layout);

/// A round length as a bar that ends at the right.
void draw_scale_bar(cv::Mat& page, cv::Point2d right_end_px, double px_per_m);

}  // namespace waymark::viewer
