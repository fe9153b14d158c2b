// SPDX-License-Identifier: BSD-3-Clause
// The layers of map.png, each drawn into one panel's piece of the page.
#pragma once

#include "viewer/core/page/map_page.hpp"

#include <vector>

namespace waymark::viewer {

/// Widths of the strokes where a corridor is large on the page.
struct StrokeWidths {
  int health_px{30};
  int true_px{8};
  int odometry_px{4};
  int estimated_px{3};
  int plate_px{7};
};

/// Finer where a building is small on the page, so that the map stays the main thing.
StrokeWidths strokes_at(double px_per_m);

constexpr double kDash_px = 14.0;
constexpr double kDashGap_px = 12.0;

/// One pixel per cell, row 0 = lowest y, BGR.
cv::Mat colour_cells(const GridMap& map);

void draw_cells(cv::Mat& panel, const View& view, const GridMap& map, const cv::Mat& cell_colours);

/// All paths, so that coinciding ones all stay visible: the broadest at the bottom, and what is
/// known at the end in dashes on top.
void draw_paths(cv::Mat& panel, const View& view, const PageContent& content,
                const StrokeWidths& widths, Odometry odometry);

void draw_particles(cv::Mat& panel, const View& view, const std::vector<Se2>& particles);

/// Where the base was first (ring) and last (arrow head in the direction of travel).
void draw_ends(cv::Mat& panel, const View& view, const std::vector<EstimatedPose>& estimates);

/// A bar where each marker hangs, on its wall.
void draw_plates(cv::Mat& panel, const View& view, const std::vector<Landmark>& landmarks,
                 double marker_size_m, int width_px);

}  // namespace waymark::viewer
