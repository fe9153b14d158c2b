// SPDX-License-Identifier: BSD-3-Clause
#include "viewer/core/painters/scan_painter.hpp"

#include "viewer/core/drawing/canvas.hpp"
#include "viewer/core/drawing/palette.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

namespace waymark::viewer {
namespace {

struct Beam {
  cv::Point2d direction{};  ///< unit vector on the picture, y down
  double range_m{};
  int marker_id{kNoMarker};
};

/// Beams with a return.
std::vector<Beam> beams_of(const AnnotatedScan& scan) {
  std::vector<Beam> beams;
  const std::size_t count =
      std::min({scan.ranges_m.size(), scan.angles_rad.size(), scan.marker_ids.size()});
  for (std::size_t i = 0; i < count; ++i) {
    if (!std::isfinite(scan.ranges_m[i])) continue;
    const double angle = scan.angles_rad[i];  // counter-clockwise from up
    beams.push_back({{-std::sin(angle), -std::cos(angle)}, scan.ranges_m[i], scan.marker_ids[i]});
  }
  return beams;
}

double ring_step_m(double reach_m) {
  return reach_m > 12.0 ? 5.0 : 1.0;
}

void draw_range_rings(cv::Mat& image, cv::Point2d centre, double reach_m, double px_per_m) {
  for (double range_m = ring_step_m(reach_m); range_m <= reach_m; range_m += ring_step_m(reach_m))
    draw_circle(image, centre, range_m * px_per_m, {palette::kHairline, 2});
}

void label_range_rings(cv::Mat& image, cv::Point2d centre, double reach_m, double px_per_m) {
  for (double range_m = ring_step_m(reach_m); range_m <= reach_m; range_m += ring_step_m(reach_m)) {
    const cv::Point2d place{centre.x, centre.y + range_m * px_per_m};
    fill_box(image, {place.x - 26, place.y - 11, 52, 22}, 6, palette::kPage);
    draw_text(image, fmt::format("{:g} m", range_m), place, Anchor::kCentre,
              {.height_px = 13.0, .colour = palette::kFaintInk});
  }
}

/// Writes each id once, beyond the ends of its beams.
void draw_ids(cv::Mat& image, const std::vector<Beam>& beams, cv::Point2d centre, double px_per_m) {
  std::map<int, std::vector<Beam>> by_id;
  for (const Beam& beam : beams) {
    if (beam.marker_id != kNoMarker) by_id[beam.marker_id].push_back(beam);
  }
  for (const auto& [id, group] : by_id) {
    cv::Point2d sum{0, 0};
    for (const Beam& beam : group)
      sum += beam.range_m * beam.direction;
    const cv::Point2d middle = sum * (1.0 / static_cast<double>(group.size()));
    const double range_m = std::max(cv::norm(middle), 1e-9);
    const cv::Point2d place = centre + middle * (px_per_m + 64.0 / range_m);
    const Font font{.height_px = 20.0, .colour = palette::text_on(colour_of_id(id)), .bold = true};
    const std::string text = std::to_string(id);
    const double width = text_width_px(text, font) + 20.0;
    fill_box(image, {place.x - width / 2, place.y - 19, width, 38}, 8, colour_of_id(id));
    draw_text(image, text, place, Anchor::kCentre, font);
  }
}

}  // namespace

cv::Mat paint_scan(const AnnotatedScan& scan, int size_px) {
  const std::vector<Beam> beams = beams_of(scan);
  double reach_m = 1.0;
  std::size_t on_markers = 0;
  for (const Beam& beam : beams) {
    reach_m = std::max(reach_m, beam.range_m);
    on_markers += beam.marker_id == kNoMarker ? 0 : 1;
  }
  const cv::Point2d centre{size_px / 2.0, size_px / 2.0 + 20.0};
  const double px_per_m = (size_px / 2.0 - 90.0) / reach_m;

  cv::Mat image{size_px, size_px, CV_8UC3, palette::kPage};
  draw_range_rings(image, centre, reach_m, px_per_m);
  // Beams on markers lie on top of the others.
  for (const Beam& beam : beams) {
    if (beam.marker_id != kNoMarker) continue;
    const cv::Point2d end = centre + beam.range_m * px_per_m * beam.direction;
    draw_line(image, centre, end, {palette::kUnknown, 1});
    fill_circle(image, end, 3.0, palette::kOccupied);
  }
  for (const Beam& beam : beams) {
    if (beam.marker_id == kNoMarker) continue;
    const cv::Point2d end = centre + beam.range_m * px_per_m * beam.direction;
    draw_line(image, centre, end, {colour_of_id(beam.marker_id), 2});
    fill_circle(image, end, 5.0, colour_of_id(beam.marker_id));
  }
  label_range_rings(image, centre, reach_m, px_per_m);
  draw_ids(image, beams, centre, px_per_m);
  fill_circle(image, centre, 13.0, palette::kInk);
  fill_polygon(
      image,
      std::vector<cv::Point2d>{
          {centre.x, centre.y - 9}, {centre.x + 6, centre.y + 6}, {centre.x - 6, centre.y + 6}},
      palette::kPage);
  draw_text(image,
            fmt::format("scan at {:.1f} s: {} beams, {} on markers", to_seconds(scan.time),
                        beams.size(), on_markers),
            {24.0, 32.0}, Anchor::kLeft, {.height_px = 18.0, .colour = palette::kInk});
  return image;
}

}  // namespace waymark::viewer
