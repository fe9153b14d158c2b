// SPDX-License-Identifier: BSD-3-Clause
// Annotations around the map on map.png: heading, scale bar, rulers.
#pragma once

#include "viewer/core/page/map_page.hpp"

#include <string>

namespace waymark::viewer {

/// Title; size of the map and length of the path; shares of the health states, and of the sources
/// that observed the motion along weak axes.
void draw_heading(cv::Mat& page, const cv::Rect& area_px, const std::string& title,
                  const PageContent& content, const Se2& view_from_map,
                  const MapThresholds& thresholds);

/// Ruler in metres below a strip.
void draw_ruler(cv::Mat& page, const Panel& panel);

/// A bracket with a letter for each strip below the overview; the same letter beside the strip.
void draw_strip_marks(cv::Mat& page, const MapPage& layout);

/// A bar of a round length.
/// @param right_end_px  its right end on the page.
void draw_scale_bar(cv::Mat& page, cv::Point2d right_end_px, double px_per_m);

}  // namespace waymark::viewer
