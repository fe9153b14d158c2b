// SPDX-License-Identifier: BSD-3-Clause
#include "viewer/core/drawing/canvas.hpp"

#include <gtest/gtest.h>

#include <array>
#include <limits>

namespace waymark::viewer {
namespace {

const cv::Scalar kBlack{0, 0, 0};
using Image = cv::Mat_<cv::Vec3b>;

Image white() {
  return Image(100, 100, cv::Vec3b{255, 255, 255});
}

bool is_blank(const Image& image) {
  return cv::countNonZero(cv::Mat(image).reshape(1) < 255) == 0;
}

TEST(DashedPolyline, AlternatesAlongTheWholePath) {
  Image image = white();
  // The second dash goes around the corner.
  const std::array<cv::Point2d, 3> path{{{0, 10}, {50, 10}, {50, 90}}};
  draw_dashed_polyline(image, path, {kBlack, 3}, 20.0, 20.0);
  EXPECT_EQ(image(10, 10)[0], 0);
  EXPECT_EQ(image(10, 30)[0], 255);
  EXPECT_EQ(image(10, 45)[0], 0);
  EXPECT_EQ(image(16, 50)[0], 0);
  EXPECT_EQ(image(32, 50)[0], 255) << "30 px after the corner: gap";
  EXPECT_EQ(image(60, 10)[0], 255);
}

TEST(DashedPolyline, DrawsNothingForEmptyOrZeroLengthPaths) {
  Image image = white();
  draw_dashed_polyline(image, {}, {kBlack, 1}, 5.0, 5.0);
  draw_dashed_polyline(image, std::array<cv::Point2d, 1>{{{5, 5}}}, {kBlack, 1}, 5.0, 5.0);
  draw_dashed_polyline(image, std::array<cv::Point2d, 2>{{{5, 5}, {5, 5}}}, {kBlack, 1}, 5.0, 5.0);
  EXPECT_TRUE(is_blank(image));
}

TEST(DashedPolyline, TerminatesForAbsurdPoints) {
  Image image = white();
  const double inf = std::numeric_limits<double>::infinity();
  const std::array<cv::Point2d, 4> path{{{5, -5}, {1e300, -5}, {inf, -inf}, {5, -5}}};
  draw_dashed_polyline(image, path, {kBlack, 1}, 5.0, 5.0);
}

TEST(TintPolygons, OverlappingPolygonsAreTintedOnce) {
  Image image = white();
  const std::vector<cv::Point2d> box{{10, 10}, {50, 10}, {50, 50}, {10, 50}};
  tint_polygons(image, {box, box}, kBlack, 0.2);
  EXPECT_NEAR(image(30, 30)[0], 204, 1);
  EXPECT_EQ(image(70, 70)[0], 255);

  Image untouched = white();
  tint_polygons(untouched, {}, kBlack, 0.2);
  EXPECT_TRUE(is_blank(untouched));
}

TEST(Text, ACharacterBeyondAsciiIsOneQuestionMark) {
  EXPECT_EQ(text_width_px("B\xC3\xBCro", {}), text_width_px("B?ro", {}));
  EXPECT_EQ(text_width_px("\xE2\x82\xAC", {}), text_width_px("?", {}));
}

TEST(Text, AFittingFontIsNoWiderThanTheLimit) {
  const Font font{.height_px = 30.0};
  EXPECT_EQ(fitting(font, "ab", 1000.0).height_px, 30.0);
  const std::string text(50, 'M');
  EXPECT_LE(text_width_px(text, fitting(font, text, 300.0)), 310.0);
}

}  // namespace
}  // namespace waymark::viewer
