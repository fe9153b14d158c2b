// SPDX-License-Identifier: BSD-3-Clause
#include "detector/core/pattern_image.hpp"

#include "marker_truth.hpp"
#include "support/marker_image.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace waymark {
namespace {

using testing::base_from_upright_marker;
using testing::ImageLook;
using testing::pattern_of;
using testing::raw_corners_px;
using testing::render_markers;

constexpr int kId = 11;

struct Sighting {
  RobotConfig robot{};
  Eigen::Isometry3d camera_from_marker{};
  Corners corners_px{};
};

/// On a wall beside the robot, seen by a camera that leans to one side.
Sighting leaning_sighting() {
  Sighting seen;
  seen.robot.camera.roll_rad = 0.15;
  seen.camera_from_marker = seen.robot.camera.base_from_camera().inverse() *
                            base_from_upright_marker({2.4, 0.9, 0.3}, -0.5 * std::numbers::pi);
  seen.corners_px = raw_corners_px(seen.robot, seen.camera_from_marker);
  return seen;
}

PatternView view_with(const PatternImage& image, const Corners& corners_px, const ImageLook& look) {
  PatternView view = image.view_of(corners_px).value();
  view.values.segment<2>(PatternView::kBlur).setConstant(look.blur_sigma_px);
  view.values[PatternView::kWhite] = look.white;
  view.values[PatternView::kBlack] = look.black;
  view.values.segment<4>(PatternView::kBeyond).setConstant(look.wall);
  return view;
}

/// Calls `visit` for the pixels in and around the marker.
template <typename Visit>
void for_each_pixel(const Corners& corners_px, const Visit& visit) {
  Eigen::Array2d low = corners_px[0].array();
  Eigen::Array2d high = low;
  for (const Eigen::Vector2d& corner_px : corners_px) {
    low = low.min(corner_px.array());
    high = high.max(corner_px.array());
  }
  constexpr int kMarginPx = 3;
  for (int v = static_cast<int>(low.y()) - kMarginPx; v <= high.y() + kMarginPx; ++v) {
    for (int u = static_cast<int>(low.x()) - kMarginPx; u <= high.x() + kMarginPx; ++u)
      visit(Eigen::Vector2i{u, v});
  }
}

TEST(PatternImage, IsWhatRaysThroughLensAndPixelsSee) {
  const Sighting seen = leaning_sighting();
  const PatternImage image{pattern_of(kId), seen.corners_px};
  for (const double blur_sigma_px : {0.3, 0.7, 1.2}) {
    const ImageLook look{
        .quiet_zone_modules = 1.0, .blur_sigma_px = blur_sigma_px, .noise_sigma = 0.0};
    const cv::Mat rendered =
        render_markers(seen.robot, {{kId, seen.camera_from_marker}}, look, Random{1});
    const PatternView view = view_with(image, seen.corners_px, look);
    double squares = 0.0;
    int count = 0;
    for_each_pixel(seen.corners_px, [&](const Eigen::Vector2i& pixel) {
      const auto modelled = image.pixel(view, pixel.cast<double>());
      ASSERT_TRUE(modelled);
      const double error = rendered.at<std::uint8_t>(pixel.y(), pixel.x()) - modelled->grey;
      EXPECT_LT(std::abs(error), 25.0) << "blur " << blur_sigma_px << " at " << pixel.transpose();
      squares += error * error;
      ++count;
    });
    EXPECT_LT(std::sqrt(squares / count), 3.0) << "of 190 grey levels, blur " << blur_sigma_px;
  }
}

TEST(PatternImage, DerivativesMatchDifferences) {
  const Sighting seen = leaning_sighting();
  const PatternImage image{pattern_of(kId), seen.corners_px};
  PatternView view = view_with(image, seen.corners_px, {.blur_sigma_px = 0.8});
  view.values[PatternView::kBlur + 1] = 0.6;
  view.values.segment<2>(PatternView::kWhite + 1) << 12.0, -7.0;
  view.values.segment<2>(PatternView::kBlack + 1) << -3.0, 5.0;
  PatternView::Vector squared_errors = PatternView::Vector::Zero();
  PatternView::Vector squares = PatternView::Vector::Zero();
  for_each_pixel(seen.corners_px, [&](const Eigen::Vector2i& pixel) {
    const Eigen::Vector2d at = pixel.cast<double>();
    const auto modelled = image.pixel(view, at);
    ASSERT_TRUE(modelled);
    for (int i = 0; i < PatternView::kSize; ++i) {
      const double step = i < PatternView::kBlur ? 2e-3 : 0.02;
      PatternView less = view;
      PatternView more = view;
      less.values[i] -= step;
      more.values[i] += step;
      const double difference =
          (image.pixel(more, at)->grey - image.pixel(less, at)->grey) / (2.0 * step);
      squares[i] += difference * difference;
      squared_errors[i] +=
          (modelled->gradient[i] - difference) * (modelled->gradient[i] - difference);
    }
  });
  // That the homography changes the blur's share of a module, too, is left out of the derivatives.
  for (int i = 0; i < PatternView::kSize; ++i) {
    EXPECT_GT(squares[i], 0.0) << i;
    EXPECT_LT(std::sqrt(squared_errors[i] / squares[i]), i < PatternView::kWhite ? 0.1 : 1e-6) << i;
  }
}

TEST(PatternImage, CornersOfAViewAreThoseItWasMadeOf) {
  const Sighting seen = leaning_sighting();
  const PatternImage image{pattern_of(kId), seen.corners_px};
  Corners moved = seen.corners_px;
  moved[2] += Eigen::Vector2d{1.5, -2.5};
  const PatternView view = image.view_of(moved).value();
  const Corners corners_px = image.corners_px(view);
  for (std::size_t k = 0; k < 4; ++k)
    EXPECT_LT((corners_px[k] - moved[k]).norm(), 1e-9);

  const auto jacobian = image.corner_jacobian(view);
  for (int i = 0; i < PatternView::kBlur; ++i) {
    constexpr double kStep = 1e-6;
    PatternView more = view;
    more.values[i] += kStep;
    const Corners there = image.corners_px(more);
    for (std::size_t k = 0; k < 4; ++k) {
      const Eigen::Vector2d rate = (there[k] - corners_px[k]) / kStep;
      EXPECT_LT((jacobian.block<2, 1>(static_cast<Eigen::Index>(2 * k), i) - rate).norm(), 1e-2);
    }
  }
}

TEST(PatternImage, ThereIsNoViewOfCornersInALine) {
  const Sighting seen = leaning_sighting();
  const PatternImage image{pattern_of(kId), seen.corners_px};
  EXPECT_FALSE(image.view_of({Eigen::Vector2d{10, 10}, Eigen::Vector2d{20, 20},
                              Eigen::Vector2d{30, 30}, Eigen::Vector2d{40, 40}}));
}

}  // namespace
}  // namespace waymark
