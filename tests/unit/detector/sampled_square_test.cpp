// SPDX-License-Identifier: BSD-3-Clause
#include "detector/core/sampled_square.hpp"

#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

#include <array>
#include <cmath>

namespace waymark {
namespace {

constexpr int kModulesPerSide = 8;
constexpr int kLeft_px = 40;
constexpr int kTop_px = 30;
constexpr double kReach_px = 3.0;
constexpr int kBlack = 30;
constexpr int kWhite = 210;
const CameraModel kPinhole{CameraConfig{}};  // no distortion: ideal pixels are raw pixels

/// A marker as from the side: a black box with a border of one module, and bits of one grey level.
cv::Mat blurred_box(cv::Size module_px, int bits, double blur_px) {
  cv::Mat image(130, 130, CV_8UC1, cv::Scalar(kWhite));
  const cv::Rect box{{kLeft_px, kTop_px}, module_px * kModulesPerSide};
  image(box).setTo(kBlack);
  image(cv::Rect{box.tl() + cv::Point{module_px}, box.br() - cv::Point{module_px}}).setTo(bits);
  cv::GaussianBlur(image, image, {}, blur_px);
  return image;
}

/// The sides of that box, clockwise from the top; pixel centres are integers.
std::array<Side, 4> sides_of_box(cv::Size module_px) {
  const double left = kLeft_px - 0.5;
  const double right = left + kModulesPerSide * module_px.width;
  const double top = kTop_px - 0.5;
  const double bottom = top + kModulesPerSide * module_px.height;
  return {Side{{left, top}, {right, top}}, Side{{right, top}, {right, bottom}},
          Side{{right, bottom}, {left, bottom}}, Side{{left, bottom}, {left, top}}};
}

SampledSquare sampled(const cv::Mat& image, cv::Size module_px) {
  return sample_square(image, kPinhole, sides_of_box(module_px), kModulesPerSide, kReach_px);
}

/// Mean offset of the measured edge from the true one, away from the corners.
double measured_bias_px(const SampledSquare& square, std::size_t side) {
  constexpr double kCorner_px = 12.0;
  const SampledSide& sampled = square.sides[side];
  double sum_px = 0.0;
  int count = 0;
  for (const EdgeProfile& profile : sampled.profiles) {
    if (std::abs(profile.along_px - 0.5 * sampled.side.length_px()) > kCorner_px) continue;
    sum_px += sampled.edge_px(profile, square.black).value();
    ++count;
  }
  EXPECT_GT(count, 10);
  return sum_px / count;
}

TEST(SampledSquare, BordersBlackAndBlurAreMeasured) {
  constexpr double kBlur_px = 1.1;
  const SampledSquare square = sampled(blurred_box({6, 9}, kBlack, kBlur_px), {6, 9});
  EXPECT_NEAR(square.black, kBlack, 8.0) << "blur brightens it a little";
  EXPECT_EQ(square.thick_side(), 0U);
  EXPECT_TRUE(square.sides[0].is_blurred());
  for (std::size_t side = 0; side < 4; ++side) {
    EXPECT_NEAR(square.sides[side].border_px, side % 2 == 0 ? 9.0 : 6.0, 1e-9);
    EXPECT_NEAR(square.sides[side].blur_px, kBlur_px, 0.1 * kBlur_px);
    EXPECT_NEAR(square.corner_margin_px(side), 3.0 * kBlur_px, 0.3 * kBlur_px);
  }
  const SampledSquare sharp = sampled(blurred_box({9, 6}, kWhite, 0.5), {9, 6});
  EXPECT_EQ(sharp.thick_side(), 1U);
  for (const SampledSide& side : sharp.sides)
    EXPECT_FALSE(side.is_blurred());
  EXPECT_EQ(sharp.corner_margin_px(0), 0.0);
}

TEST(SampledSquare, TheMoreBlurredNeighbourBendsTheEndsOfASide) {
  SampledSquare square;
  square.sides[1] = {.border_px = 6.0, .blur_px = 2.0};
  square.sides[3] = {.border_px = 6.0, .blur_px = 1.0};
  EXPECT_DOUBLE_EQ(square.corner_margin_px(0), 6.0);
  EXPECT_DOUBLE_EQ(square.corner_margin_px(2), 6.0);
  EXPECT_DOUBLE_EQ(square.corner_margin_px(1), 0.0) << "its neighbours are sharp";
  square.sides[1].border_px = 1.9;  // too thin for a measurement of its blur
  EXPECT_DOUBLE_EQ(square.corner_margin_px(0), 3.0);
}

TEST(SampledSquare, TheFartherSideOfAnObliqueSquareHasTheThinnerBorder) {
  std::array<Side, 4> sides = sides_of_box({6, 6});
  sides[1].start_px.y() += 8.0;  // the right side is farther away
  sides[1].end_px.y() -= 8.0;
  sides[0].end_px = sides[1].start_px;
  sides[2].start_px = sides[1].end_px;
  const SampledSquare square =
      sample_square(blurred_box({6, 6}, kBlack, 1.0), kPinhole, sides, kModulesPerSide, kReach_px);
  EXPECT_LT(square.sides[1].border_px, square.sides[3].border_px - 1.0);
  EXPECT_NEAR(square.sides[0].border_px, square.sides[2].border_px, 1e-9);
}

TEST(SampledSquare, BlurMovesAThinSideInwardsIfWhiteBitsLieBehindItAsTheModelPredicts) {
  constexpr double kBlur_px = 1.0;
  const cv::Size oblique_px{3, 9};
  for (const int bits : {kBlack, kWhite}) {
    const cv::Mat image = blurred_box(oblique_px, bits, kBlur_px);
    const SampledSquare square = sampled(image, oblique_px);
    for (const std::size_t side : {1, 3}) {
      const double bias_px = measured_bias_px(square, side);
      EXPECT_NEAR(bias_px, bits == kWhite ? -0.07 : 0.0, 0.01);
      EXPECT_NEAR(blur_bias_px(image, kPinhole, square, side).value(), bias_px, 0.02);
    }
  }
}

}  // namespace
}  // namespace waymark
