// SPDX-License-Identifier: BSD-3-Clause
#include "viewer/core/drawing/canvas.hpp"

#include <opencv2/imgproc.hpp>

#include <algorithm>
#include <cmath>
#include <vector>

namespace waymark::viewer {
namespace {

constexpr int kShift = 4;  // fractional bits of OpenCV's fixed-point coordinates
constexpr double kOne = 1 << kShift;
/// Coordinates are clamped to +- this value, so that fixed-point numbers do not overflow.
constexpr double kFarAway_px = 1e6;

int fixed(double value_px) {
  if (!std::isfinite(value_px)) value_px = kFarAway_px;
  return static_cast<int>(std::lround(std::clamp(value_px, -kFarAway_px, kFarAway_px) * kOne));
}

cv::Point fixed(cv::Point2d point_px) {
  return {fixed(point_px.x), fixed(point_px.y)};
}

std::vector<cv::Point> fixed(std::span<const cv::Point2d> points_px) {
  std::vector<cv::Point> points;
  points.reserve(points_px.size());
  for (const cv::Point2d& point : points_px)
    points.push_back(fixed(point));
  return points;
}

constexpr int kFace = cv::FONT_HERSHEY_DUPLEX;
constexpr double kCapitalHeight_px = 21.0;  // height of a Hershey capital at scale 1

std::string ascii(std::string_view utf8) {
  std::string text;
  for (const char byte : utf8) {
    const auto bits = static_cast<unsigned char>(byte);
    const bool continues = (bits & 0xC0U) == 0x80U;
    if (!continues) text += bits < 0x80U ? byte : '?';
  }
  return text;
}

int stroke_px(const Font& font) {
  const double stroke = font.height_px / (font.bold ? 8.0 : 13.0);
  return std::max(1, static_cast<int>(std::lround(stroke)));
}

}  // namespace

void draw_line(cv::Mat& image, cv::Point2d from_px, cv::Point2d to_px, const Pen& pen) {
  cv::line(image, fixed(from_px), fixed(to_px), pen.colour, pen.width_px, cv::LINE_AA, kShift);
}

void draw_polyline(cv::Mat& image, std::span<const cv::Point2d> points_px, const Pen& pen) {
  if (points_px.size() < 2) return;
  cv::polylines(image, fixed(points_px), false, pen.colour, pen.width_px, cv::LINE_AA, kShift);
}

void draw_dashed_polyline(cv::Mat& image, std::span<const cv::Point2d> points_px, const Pen& pen,
                          double dash_px, double gap_px) {
  constexpr double kLongStep_px = 5000.0;
  bool is_dash = true;
  double left_px = dash_px;  // remaining length of the current dash or gap
  std::vector<cv::Point2d> dash;
  for (std::size_t i = 1; i < points_px.size(); ++i) {
    cv::Point2d from = points_px[i - 1];
    const cv::Point2d to = points_px[i];
    double step_px = cv::norm(to - from);
    if (!(step_px <= kLongStep_px)) {
      draw_line(image, from, to, pen);
      continue;
    }
    while (step_px > 0.0) {
      const double part_px = std::min(step_px, left_px);
      const cv::Point2d end = from + (part_px / step_px) * (to - from);
      if (is_dash && dash.empty()) dash.push_back(from);
      if (is_dash) dash.push_back(end);
      from = end;
      step_px -= part_px;
      left_px -= part_px;
      if (left_px > 0.0) continue;
      draw_polyline(image, dash, pen);
      dash.clear();
      is_dash = !is_dash;
      left_px = is_dash ? dash_px : gap_px;
    }
  }
  draw_polyline(image, dash, pen);
}

void draw_circle(cv::Mat& image, cv::Point2d centre_px, double radius_px, const Pen& pen) {
  cv::circle(image, fixed(centre_px), fixed(std::abs(radius_px)), pen.colour, pen.width_px,
             cv::LINE_AA, kShift);
}

void fill_circle(cv::Mat& image, cv::Point2d centre_px, double radius_px,
                 const cv::Scalar& colour) {
  cv::circle(image, fixed(centre_px), fixed(std::abs(radius_px)), colour, cv::FILLED, cv::LINE_AA,
             kShift);
}

void tint_polygons(cv::Mat& image, const std::vector<std::vector<cv::Point2d>>& polygons_px,
                   const cv::Scalar& colour, double opacity) {
  if (polygons_px.empty()) return;
  cv::Mat painted = image.clone();
  for (const std::vector<cv::Point2d>& polygon : polygons_px)
    fill_polygon(painted, polygon, colour);
  cv::addWeighted(painted, opacity, image, 1.0 - opacity, 0.0, image);
}

void fill_polygon(cv::Mat& image, std::span<const cv::Point2d> corners_px,
                  const cv::Scalar& colour) {
  cv::fillPoly(image, std::vector<std::vector<cv::Point>>{fixed(corners_px)}, colour, cv::LINE_AA,
               kShift);
}

void fill_box(cv::Mat& image, const cv::Rect2d& box_px, double corner_radius_px,
              const cv::Scalar& colour) {
  const double radius = std::min({corner_radius_px, box_px.width / 2, box_px.height / 2});
  const cv::Point2d inner_tl{box_px.x + radius, box_px.y + radius};
  const cv::Point2d inner_br{box_px.br().x - radius, box_px.br().y - radius};
  std::vector<cv::Point2d> outline;
  const auto add_corner = [&](cv::Point2d centre, int first_degree) {
    for (int degree = first_degree; degree <= first_degree + 90; degree += 15) {
      const double angle = degree * CV_PI / 180.0;
      outline.push_back(centre + radius * cv::Point2d{std::cos(angle), std::sin(angle)});
    }
  };
  add_corner(inner_br, 0);
  add_corner({inner_tl.x, inner_br.y}, 90);
  add_corner(inner_tl, 180);
  add_corner({inner_br.x, inner_tl.y}, 270);
  fill_polygon(image, outline, colour);
}

double text_width_px(std::string_view text, const Font& font) {
  int baseline = 0;
  return cv::getTextSize(ascii(text), kFace, font.height_px / kCapitalHeight_px, stroke_px(font),
                         &baseline)
      .width;
}

Font fitting(Font font, std::string_view text, double most_px) {
  const double width_px = text_width_px(text, font);
  if (width_px > most_px) font.height_px *= most_px / width_px;
  return font;
}

void draw_text(cv::Mat& image, std::string_view text, cv::Point2d anchor_px, Anchor anchor,
               const Font& font) {
  const double width = text_width_px(text, font);
  const double left = anchor == Anchor::kLeft     ? anchor_px.x
                      : anchor == Anchor::kCentre ? anchor_px.x - width / 2
                                                  : anchor_px.x - width;
  const cv::Point origin{static_cast<int>(std::lround(left)),
                         static_cast<int>(std::lround(anchor_px.y + font.height_px / 2))};
  cv::putText(image, ascii(text), origin, kFace, font.height_px / kCapitalHeight_px, font.colour,
              stroke_px(font), cv::LINE_AA);
}

}  // namespace waymark::viewer
