// SPDX-License-Identifier: BSD-3-Clause
// The layers of map.png, each drawn into one panel's piece of the page.
#pragma once

#include "viewer/core/drawing/palette.hpp"
#include "viewer/core/page/map_page.hpp"

#include <functional>
#include <vector>

namespace waymark::viewer {

/// Widths of strokes; the defaults are for 80 px/m and more (mark_scale()).
struct StrokeWidths {
  int health_px{30};
  int true_px{8};
  int odometry_px{4};
  int estimated_px{3};
  int plate_px{7};
};

/// Finer strokes at smaller scales, so that they do not cover the map.
StrokeWidths strokes_at(double px_per_m);

constexpr double kDash_px = 14.0;
constexpr double kDashGap_px = 12.0;

using CellColour = std::function<Colour(int occupancy_percent, int marker_id)>;

/// Walls dark, free space white.
CellColour occupancy_colour();

/// Where several cells share a pixel, they are drawn as one (shrunk()).
void draw_cells(cv::Mat& panel, const MapViewport& view, const GridMap& map,
                const CellColour& colour_of_cell);

/// All paths, from the broadest stroke at the bottom to the finest, so that coinciding ones stay
/// visible; the final trajectory is dashed, on top.
void draw_paths(cv::Mat& panel, const MapViewport& view, const PageContent& content,
                const StrokeWidths& widths, OdometryPath odometry);

void draw_particles(cv::Mat& panel, const MapViewport& view, const std::vector<Se2>& particles);

/// First pose of the base (ring) and last one (arrow head along the heading).
void draw_ends(cv::Mat& panel, const MapViewport& view,
               const std::vector<EstimatedPose>& estimates);

/// A bar for each marker, along its wall, and a short line towards the side that it faces.
void draw_plates(cv::Mat& panel, const MapViewport& view, const std::vector<Landmark>& landmarks,
                 double marker_size_m, int width_px);

}  // namespace waymark::viewer
