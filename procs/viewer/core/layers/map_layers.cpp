// SPDX-License-Identifier: BSD-3-Clause
#include "viewer/core/layers/map_layers.hpp"

#include "viewer/core/drawing/canvas.hpp"
#include "viewer/core/drawing/cell_pixels.hpp"
#include "viewer/core/drawing/path_points.hpp"
#include "viewer/core/layers/marker_labels.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace waymark::viewer {

StrokeWidths strokes_at(double px_per_m) {
  const double scale = mark_scale(px_per_m);
  const auto scaled = [scale](int width_px, int least_px) {
    return std::max(least_px, static_cast<int>(std::lround(scale * width_px)));
  };
  const StrokeWidths full{};
  return {.health_px = scaled(full.health_px, 8),
          .true_px = scaled(full.true_px, 4),
          .odometry_px = scaled(full.odometry_px, 2),
          .estimated_px = scaled(full.estimated_px, 2),
          .plate_px = scaled(full.plate_px, 4)};
}

CellColour occupancy_colour() {
  std::array<Colour, 101> colours;
  for (int percent = 0; percent <= 100; ++percent)
    colours[static_cast<std::size_t>(percent)] =
        to_colour(blend(palette::kFree, palette::kOccupied, percent / 100.0));
  return [colours, unknown = to_colour(palette::kUnknown)](int percent, int /*marker_id*/) {
    return percent < 0 ? unknown : colours[static_cast<std::size_t>(std::min(percent, 100))];
  };
}

void draw_cells(cv::Mat& panel, const MapViewport& view, const GridMap& map,
                const CellColour& colour_of_cell) {
  panel.setTo(palette::kUnknown);
  if (map.empty()) return;
  const double cells_per_px = 1.0 / (view.px_per_m * map.resolution_m);
  const int longest = std::max(map.occupancy_percent.cols, map.occupancy_percent.rows);
  constexpr double kRounding = 1e-6;
  const GridMap cells =
      shrunk(map, static_cast<int>(std::ceil(std::min(cells_per_px - kRounding, 1.0 * longest))));
  cv::Mat_<Colour> pixels = panel;
  for_each_pixel_on_map(view, cells, panel.size(), [&](cv::Point pixel, cv::Point cell) {
    pixels(pixel) = colour_of_cell(cells.occupancy_percent(cell), cells.marker_ids(cell));
  });
}

void draw_paths(cv::Mat& panel, const MapViewport& view, const PageContent& content,
                const StrokeWidths& widths, OdometryPath odometry) {
  draw_polyline(panel, points_on_page(view, content.truth_in_map),
                {palette::kTrue, widths.true_px});
  if (odometry == OdometryPath::kIncluded) {
    draw_polyline(panel, points_on_page(view, content.odometry_in_map),
                  {palette::kOdometry, widths.odometry_px});
  }
  draw_polyline(panel, points_on_page(view, content.estimates),
                {palette::kEstimated, widths.estimated_px});
  draw_dashed_polyline(panel, points_on_page(view, content.final_in_map),
                       {palette::kFinal, widths.estimated_px}, kDash_px, kDashGap_px);
}

void draw_particles(cv::Mat& panel, const MapViewport& view, const std::vector<Se2>& particles) {
  for (const Se2& particle : particles)
    fill_circle(panel, view(particle.translation()), 2.0, palette::kParticle);
}

void draw_ends(cv::Mat& panel, const MapViewport& view,
               const std::vector<EstimatedPose>& estimates) {
  if (estimates.empty()) return;
  const cv::Point2d start = view(estimates.front().map_from_base.translation());
  const double scale = std::max(0.6, mark_scale(view.px_per_m));
  fill_circle(panel, start, 12.0 * scale, palette::kPage);
  draw_circle(panel, start, 11.0 * scale,
              {palette::kEstimated, static_cast<int>(std::lround(5.0 * scale))});
  const Se2& last = estimates.back().map_from_base;
  const cv::Point2d end = view(last.translation());
  const cv::Point2d ahead = view.direction(last.theta());
  const cv::Point2d left{ahead.y, -ahead.x};
  const auto arrow = [&](double size_px) {
    return std::array<cv::Point2d, 4>{
        end + 1.3 * size_px * ahead, end - size_px * ahead + size_px * left,
        end - 0.5 * size_px * ahead, end - size_px * ahead - size_px * left};
  };
  fill_polygon(panel, arrow(21.0 * scale), palette::kPage);
  fill_polygon(panel, arrow(16.0 * scale), palette::kEstimated);
}

void draw_plates(cv::Mat& panel, const MapViewport& view, const std::vector<Landmark>& landmarks,
                 double marker_size_m, int width_px) {
  for (const Landmark& landmark : landmarks) {
    const cv::Point2d centre = view(landmark.map_from_marker.translation());
    const cv::Point2d facing = view.direction(landmark.map_from_marker.theta());
    const cv::Point2d along{-facing.y, facing.x};
    const double half_px = std::max(0.5 * marker_size_m * view.px_per_m, 3.0);
    const cv::Scalar colour = colour_of(landmark.state);
    draw_line(panel, centre - half_px * along, centre + half_px * along, {colour, width_px});
    draw_line(panel, centre, centre + 1.8 * width_px * facing, {colour, std::max(1, width_px / 2)});
  }
}

}  // namespace waymark::viewer
