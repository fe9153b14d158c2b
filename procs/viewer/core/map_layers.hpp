// SPDX-License-Identifier: BSD-3-Clause
// The layers of map.png, each drawn into one panel's piece of the page.
#pragma once

#include "viewer/core/map_page.hpp"

#include <vector>

namespace waymark::viewer {

/// Widths of the strokes; the overview has finer ones.
struct StrokeWidths {
  int health_px{20};
  int true_px{8};
  int odometry_px{4};
  int estimated_px{3};
  int plate_px{7};
};

/// One pixel per cell, row 0 = lowest y, BGR.
cv::Mat colour_cells(const GridMap& map);

void draw_cells(cv::Mat& panel, const View& view, const GridMap& map, const cv::Mat& cell_colours);

/// A broad band below the estimated path wherever its health is not `tracking`.
void draw_health(cv::Mat& panel, const View& view, const std::vector<EstimatedPose>& estimates,
                 int width_px);

/// All three paths, so that coinciding ones all stay visible: the broadest at the bottom.
void draw_paths(cv::Mat& panel, const View& view, const PageContent& content,
                const StrokeWidths& widths);

void draw_particles(cv::Mat& panel, const View& view, const std::vector<Se2>& particles);

/// How many times larger than 3 sigma the ellipses are drawn, so that they can be seen.
int ellipse_magnification(const std::vector<EstimatedPose>& estimates, double spacing_m,
                          double px_per_m);

/// 3-sigma ellipses of the position, magnified, every few metres of the path.
void draw_ellipses(cv::Mat& panel, const View& view, const std::vector<EstimatedPose>& estimates,
                   double spacing_m, int magnification);

/// Where the base was first (ring) and last (arrow head in the direction of travel).
void draw_ends(cv::Mat& panel, const View& view, const std::vector<EstimatedPose>& estimates);

/// A bar where each marker hangs, on its wall.
void draw_plates(cv::Mat& panel, const View& view, const std::vector<Landmark>& landmarks,
                 double marker_size_m, int width_px);

}  // namespace waymark::viewer
