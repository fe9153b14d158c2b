// SPDX-License-Identifier: BSD-3-Clause
// Anti-aliased strokes and text at sub-pixel positions. Positions in pixels, y down; drawing is
// clipped to the image.
#pragma once

#include <opencv2/core.hpp>

#include <span>
#include <string_view>
#include <vector>

namespace waymark::viewer {

struct Pen {
  cv::Scalar colour{};
  int width_px{1};
};

void draw_line(cv::Mat& image, cv::Point2d from_px, cv::Point2d to_px, const Pen& pen);
void draw_polyline(cv::Mat& image, std::span<const cv::Point2d> points_px, const Pen& pen);
/// Steps longer than 5000 px, which lead far off the page, are drawn solid: dashes would be costly.
void draw_dashed_polyline(cv::Mat& image, std::span<const cv::Point2d> points_px, const Pen& pen,
                          double dash_px, double gap_px);
void draw_circle(cv::Mat& image, cv::Point2d centre_px, double radius_px, const Pen& pen);
void fill_circle(cv::Mat& image, cv::Point2d centre_px, double radius_px, const cv::Scalar& colour);
/// Blends the union of the polygons with a colour, so that overlaps are not darker.
void tint_polygons(cv::Mat& image, const std::vector<std::vector<cv::Point2d>>& polygons_px,
                   const cv::Scalar& colour, double opacity);
void fill_polygon(cv::Mat& image, std::span<const cv::Point2d> corners_px,
                  const cv::Scalar& colour);
/// A box with rounded corners.
void fill_box(cv::Mat& image, const cv::Rect2d& box_px, double corner_radius_px,
              const cv::Scalar& colour);

struct Font {
  double height_px{16.0};  ///< height of a capital letter
  cv::Scalar colour{};
  bool bold{false};
};

enum class Anchor { kLeft, kCentre, kRight };

/// Width of a line of text in UTF-8. OpenCV's fonts have ASCII only: any other character is a
/// question mark.
double text_width_px(std::string_view text, const Font& font);
/// The font, or a smaller one in which the text is no wider than the limit.
Font fitting(Font font, std::string_view text, double most_px);
/// Writes a line of text whose capitals are centred vertically on the anchor.
void draw_text(cv::Mat& image, std::string_view text, cv::Point2d anchor_px, Anchor anchor,
               const Font& font);

}  // namespace waymark::viewer
