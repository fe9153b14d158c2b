// SPDX-License-Identifier: BSD-3-Clause
// Finds what the painters have drawn: places of a colour, and text.
#pragma once

#include "viewer/core/drawing/canvas.hpp"
#include "viewer/core/drawing/palette.hpp"

#include <opencv2/imgproc.hpp>

#include <algorithm>
#include <string>
#include <vector>

namespace waymark::viewer {

inline cv::Mat mask_of_colour(const cv::Mat& picture, const cv::Scalar& colour) {
  cv::Mat mask;
  cv::inRange(picture, colour, colour, mask);
  return mask;
}

inline int count_pixels(const cv::Mat& picture, const cv::Scalar& colour) {
  return cv::countNonZero(mask_of_colour(picture, colour));
}

inline cv::Rect box_of_colour(const cv::Mat& picture, const cv::Scalar& colour) {
  return cv::boundingRect(mask_of_colour(picture, colour));
}

/// Centres of the connected spots of a colour, from the top.
inline std::vector<cv::Point2d> spots_of_colour(const cv::Mat& picture, const cv::Scalar& colour) {
  cv::Mat labels, statistics;
  cv::Mat_<double> centres;
  const int count = cv::connectedComponentsWithStats(mask_of_colour(picture, colour), labels,
                                                     statistics, centres);
  std::vector<cv::Point2d> spots;
  for (int i = 1; i < count; ++i)  // 0 is the background
    spots.emplace_back(centres(i, 0), centres(i, 1));
  std::ranges::sort(spots, {}, &cv::Point2d::y);
  return spots;
}

/// Whether the text stands anywhere on the white page, with nothing before or behind it.
inline bool shows_text(const cv::Mat& page, const std::string& text, const Font& font) {
  constexpr int kRoom_px = 12;
  const int height_px = static_cast<int>(2.0 * font.height_px);
  const int width_px = static_cast<int>(text_width_px(text, font)) + 2 * kRoom_px;
  cv::Mat expected{height_px, width_px, CV_8UC3, palette::kPage};
  draw_text(expected, text, {1.0 * kRoom_px, font.height_px}, Anchor::kLeft, font);
  if (expected.cols > page.cols || expected.rows > page.rows) return false;
  cv::Mat differences;
  cv::matchTemplate(page, expected, differences, cv::TM_SQDIFF);
  double least = 0.0;
  cv::minMaxLoc(differences, &least);
  return least < 0.5 * 255.0 * 255.0;  // less than one pixel, for rounding in matchTemplate
}

}  // namespace waymark::viewer
