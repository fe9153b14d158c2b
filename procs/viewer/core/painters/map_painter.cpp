// SPDX-License-Identifier: BSD-3-Clause
#include "viewer/core/painters/map_painter.hpp"

#include "viewer/core/annotations/map_annotations.hpp"
#include "viewer/core/annotations/map_legend.hpp"
#include "viewer/core/drawing/palette.hpp"
#include "viewer/core/layers/change_layer.hpp"
#include "viewer/core/layers/map_layers.hpp"
#include "viewer/core/layers/marker_labels.hpp"
#include "viewer/core/layers/path_marks.hpp"
#include "viewer/core/page/map_page.hpp"

#include <opencv2/imgproc.hpp>

#include <algorithm>

namespace waymark::viewer {
namespace {

constexpr StrokeWidths kFineStrokes{
    .health_px = 10, .true_px = 5, .odometry_px = 3, .estimated_px = 2, .plate_px = 4};

double label_height_px(double px_per_m) {
  return std::clamp(0.16 * px_per_m, 13.0, 21.0);
}

void draw_overview(cv::Mat& page, const Panel& overview, const PageContent& content,
                   const CellColour& cell_colour, const MapPageStyle& style) {
  cv::Mat panel = page(overview.page_px);
  draw_cells(panel, overview.view, content.map, cell_colour);
  draw_health(panel, overview.view, content.estimates, kFineStrokes.health_px);
  draw_paths(panel, overview.view, content, kFineStrokes, OdometryPath::kIncluded);
  draw_plates(panel, overview.view, content.landmarks, style.marker_size_m, kFineStrokes.plate_px);
}

void draw_strip(cv::Mat& page, const Panel& strip, const PageContent& content,
                const CellColour& cell_colour, const MapPageStyle& style,
                const UncertaintyMarks& marks, OdometryPath odometry) {
  cv::Mat panel = page(strip.page_px);
  const MapViewport& view = strip.view;
  const StrokeWidths widths = strokes_at(view.px_per_m);
  draw_cells(panel, view, content.map, cell_colour);
  draw_health(panel, view, content.estimates, widths.health_px);
  draw_particles(panel, view, content.particles);
  draw_ellipses(panel, view, marks);
  draw_paths(panel, view, content, widths, odometry);
  draw_weak_axes(panel, view, marks);
  draw_ends(panel, view, content.estimates);
  const double text_px = label_height_px(view.px_per_m);
  const auto labels = place_labels(content.landmarks, content.map, view, text_px);
  draw_changes(panel, view, content.changes);
  draw_labels(panel, labels, text_px);
  draw_plates(panel, view, content.landmarks, style.marker_size_m, widths.plate_px);
  draw_ruler(page, strip);
}

}  // namespace

cv::Mat paint_map(const Scene& scene, const MapPageStyle& style) {
  const PageContent content = content_of(scene);
  const MapPage layout = lay_out(content, style);
  const CellColour cell_colour = occupancy_colour();
  const double px_per_m = layout.strips.front().view.px_per_m;
  const UncertaintyMarks marks = choose_marks(content.estimates, px_per_m, style.mark_spacing_px);

  cv::Mat page{layout.size_px, CV_8UC3, palette::kPage};
  draw_heading(page, layout.heading_px, scene.title, content,
               layout.strips.front().view.view_from_map, style.thresholds);
  if (layout.overview) {
    draw_overview(page, *layout.overview, content, cell_colour, style);
    draw_strip_marks(page, layout);
  }
  for (const Panel& strip : layout.strips)
    draw_strip(page, strip, content, cell_colour, style, marks, layout.odometry_in_strips);
  draw_scale_bar(page, {layout.heading_px.br().x - 2.0, layout.heading_px.y + 46.0}, px_per_m);
  const int bottom_px = draw_legend(page, layout, content, marks);
  return page(cv::Rect{0, 0, page.cols, bottom_px}).clone();
}

}  // namespace waymark::viewer
