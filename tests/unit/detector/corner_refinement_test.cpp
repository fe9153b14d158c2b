// SPDX-License-Identifier: BSD-3-Clause
#include "detector/core/corner_refinement.hpp"

#include "marker_truth.hpp"
#include "support/marker_image.hpp"

#include <gtest/gtest.h>
#include <opencv2/aruco.hpp>
#include <opencv2/imgproc.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace waymark {
namespace {

using testing::base_from_upright_marker;
using testing::ImageLook;
using testing::pattern_of;
using testing::raw_corners_px;
using testing::render_markers;

constexpr int kId = 7;

struct Scene {
  RobotConfig robot{};
  Eigen::Isometry3d camera_from_marker{};
  Corners true_raw_px{};
  cv::Mat image{};
};

Scene scene_with(const RobotConfig& robot, const Eigen::Isometry3d& base_from_marker,
                 const ImageLook& look) {
  Scene scene{.robot = robot};
  scene.camera_from_marker = robot.camera.base_from_camera().inverse() * base_from_marker;
  scene.true_raw_px = raw_corners_px(robot, scene.camera_from_marker);
  scene.image = render_markers(robot, {{kId, scene.camera_from_marker}}, look, Random{5});
  return scene;
}

/// Corners as from the first stage: moved inwards.
Corners pulled_inwards(const Corners& corners, double pull_px) {
  const Eigen::Vector2d centre = 0.25 * (corners[0] + corners[1] + corners[2] + corners[3]);
  Corners pulled;
  for (std::size_t k = 0; k < 4; ++k)
    pulled[k] = corners[k] + pull_px * (centre - corners[k]).normalized();
  return pulled;
}

Corners refined_error_px(const Scene& scene, double pull_px) {
  const CameraModel camera{scene.robot.camera};
  const MeasuredCorners corners = refine_corners(
      scene.image, camera, pulled_inwards(scene.true_raw_px, pull_px), pattern_of(kId), {});
  EXPECT_TRUE(corners.refined);
  Corners error;
  for (std::size_t k = 0; k < 4; ++k)
    error[k] = camera.raw_from_ideal(corners.ideal_px[k]) - scene.true_raw_px[k];
  return error;
}

TEST(CornerRefinement, CornersAreFoundWithoutBiasWhereverThePixelsLie) {
  const ImageLook no_noise{.noise_sigma = 0.0};
  for (const double shift_m : {0.0, 0.0013, 0.0026, 0.0039}) {  // 0 to 0.75 px
    const Scene frontal = scene_with(
        {}, base_from_upright_marker({2.6, shift_m, 0.2 + shift_m}, std::numbers::pi), no_noise);
    for (const Eigen::Vector2d& error : refined_error_px(frontal, 0.7))
      EXPECT_LT(error.norm(), 0.02) << "shift " << shift_m;
    const Scene oblique = scene_with(
        {}, base_from_upright_marker({2.6 + shift_m, 1.0, 0.25}, -0.5 * std::numbers::pi),
        no_noise);
    for (const Eigen::Vector2d& error : refined_error_px(oblique, 0.7))
      EXPECT_LT(error.norm(), 0.03) << "shift " << shift_m;
  }
}

/// Mean error of each corner over poses in a corridor 2 m wide.
Corners mean_error_in_corridor_px(double wall_y_m, const ImageLook& look, double farthest_m) {
  Corners sum{Eigen::Vector2d::Zero(), Eigen::Vector2d::Zero(), Eigen::Vector2d::Zero(),
              Eigen::Vector2d::Zero()};
  Random random{3};
  constexpr int kPoses = 20;
  const double camera_x_m = RobotConfig{}.camera.x_m;
  for (int pose = 0; pose < kPoses; ++pose) {
    const Eigen::Vector3d centre_m{camera_x_m + random.uniform(2.0, farthest_m),
                                   wall_y_m + random.uniform(-0.1, 0.1), 0.3};
    const double facing_rad = wall_y_m > 0.0 ? -0.5 * std::numbers::pi : 0.5 * std::numbers::pi;
    const Scene scene = scene_with({}, base_from_upright_marker(centre_m, facing_rad), look);
    const Corners error = refined_error_px(scene, 0.7);
    for (std::size_t k = 0; k < 4; ++k)
      sum[k] += error[k] / kPoses;
  }
  return sum;
}

TEST(CornerRefinement, CornersInACorridorAreUnbiasedOnBothWalls) {
  // An error that all markers of a corridor have in common does not average out along it.
  for (const double wall_y_m : {1.0, -1.0}) {
    for (const Eigen::Vector2d& error :
         mean_error_in_corridor_px(wall_y_m, {.blur_sigma_px = 0.0}, 3.3))
      EXPECT_LT(error.cwiseAbs().maxCoeff(), 0.01) << "pixels' own area, wall at " << wall_y_m;
    for (const Eigen::Vector2d& error :
         mean_error_in_corridor_px(wall_y_m, {.blur_sigma_px = 0.6}, 2.7))
      EXPECT_LT(error.cwiseAbs().maxCoeff(), 0.01) << "blurred, wall at " << wall_y_m;
  }
}

// Seen from the side, a quiet zone of one module is two or three pixels wide: the wall beyond it
// must not count as white.
TEST(CornerRefinement, WhatLiesBeyondANarrowQuietZoneDoesNotBiasCorners) {
  for (const double wall : {40.0, 140.0}) {
    for (const double blur_sigma_px : {0.0, 0.6}) {
      for (const double wall_y_m : {1.0, -1.0}) {
        const Corners errors = mean_error_in_corridor_px(
            wall_y_m, {.wall = wall, .quiet_zone_modules = 1.0, .blur_sigma_px = blur_sigma_px},
            3.3);
        for (const Eigen::Vector2d& error : errors)
          EXPECT_LT(error.cwiseAbs().maxCoeff(), 0.02)
              << "wall " << wall << " at " << wall_y_m << ", blur " << blur_sigma_px;
      }
    }
  }
}

TEST(CornerRefinement, AMarkerThatIsSeenAlmostEdgeOnHasFiniteCorners) {
  for (const double ahead_m : {2.5, 3.5, 4.5, 6.0, 8.0}) {
    for (const double aside_m : {0.3, 0.5, 0.8}) {
      const Scene scene = scene_with(
          {}, base_from_upright_marker({ahead_m, aside_m, 0.25}, -0.5 * std::numbers::pi),
          {.wall = 15.0, .quiet_zone_modules = 1.0});
      const MeasuredCorners corners =
          refine_corners(scene.image, CameraModel{scene.robot.camera},
                         pulled_inwards(scene.true_raw_px, 0.3), pattern_of(kId), {});
      EXPECT_TRUE(corners.covariance.allFinite());
      for (std::size_t k = 0; k < 4; ++k)
        EXPECT_LT((corners.ideal_px[k] - scene.true_raw_px[k]).norm(), 5.5)
            << ahead_m << " m ahead, " << aside_m << " m aside";
    }
  }
}

// White bits behind a thin border brighten it by blur: all four sides would move outwards, and the
// marker would be measured too near.
TEST(CornerRefinement, SmallMarkersHaveNoSizeBias) {
  for (const double ahead_m : {8.0, 8.7, 9.4, 10.1, 10.8}) {  // the border is 2.5 to 3.3 px thick
    for (const double shift_m : {0.0, 0.005, 0.01, 0.015}) {
      const Scene scene = scene_with(
          {}, base_from_upright_marker({ahead_m, shift_m, 0.2 + shift_m}, std::numbers::pi),
          {.noise_sigma = 0.0});
      const Corners error = refined_error_px(scene, 0.3);
      const Eigen::Vector2d diagonal = (scene.true_raw_px[2] - scene.true_raw_px[0]).normalized();
      const double side_outwards_px = 0.5 * diagonal.dot(error[2] - error[0]) / std::numbers::sqrt2;
      EXPECT_LT(std::abs(side_outwards_px), 0.03) << ahead_m << " m ahead, shift " << shift_m;
    }
  }
}

// Blur mixes the bits behind a thin border into its edge, most on the marker's far side.
TEST(CornerRefinement, CornersOfABlurredCameraAreNearlyUnbiased) {
  for (const double wall_y_m : {1.0, -1.0}) {
    for (const Eigen::Vector2d& error :
         mean_error_in_corridor_px(wall_y_m, {.blur_sigma_px = 1.0}, 3.0))
      EXPECT_LT(error.cwiseAbs().maxCoeff(), 0.01) << "wall at " << wall_y_m;
  }
}

TEST(CornerRefinement, BlurMakesCornersLessCertain) {
  const auto variance_of = [](double blur_sigma_px) {
    const Scene scene =
        scene_with({}, base_from_upright_marker({2.4, 1.0, 0.25}, -0.5 * std::numbers::pi),
                   {.blur_sigma_px = blur_sigma_px});
    const CameraModel camera{scene.robot.camera};
    return refine_corners(scene.image, camera, pulled_inwards(scene.true_raw_px, 0.7),
                          pattern_of(kId), {})
        .covariance.trace();
  };
  EXPECT_GT(variance_of(1.0), 1.5 * variance_of(0.3));
}

TEST(CornerRefinement, TheMeasuredBlurIsTheStandardDeviationOfTheGaussian) {
  constexpr int kSide_px = 160;
  const auto dictionary = *find_dictionary(RobotConfig{}.markers.dictionary);
  cv::Mat marker;
  cv::aruco::drawMarker(cv::makePtr<cv::aruco::Dictionary>(dictionary), kId, kSide_px, marker);
  const CameraConfig camera{};
  for (const double sigma_px : {1.0, 2.0, 3.5}) {
    cv::Mat image{camera.height_px, camera.width_px, CV_8UC1, cv::Scalar{230}};
    marker.copyTo(image(cv::Rect{200, 150, kSide_px, kSide_px}));
    cv::GaussianBlur(image, image, {}, sigma_px);
    const double right = 200 + kSide_px - 0.5;
    const double bottom = 150 + kSide_px - 0.5;
    const MeasuredCorners corners = refine_corners(
        image, CameraModel{camera},
        {Eigen::Vector2d{199.5, 149.5}, {right, 149.5}, {right, bottom}, {199.5, bottom}},
        pattern_of(kId), {});
    EXPECT_TRUE(corners.refined);
    EXPECT_NEAR(corners.blur_px, sigma_px, 0.12 * sigma_px);
  }
}

TEST(CornerRefinement, EdgesBentByALensDoNotBiasCorners) {
  RobotConfig robot;
  robot.camera.distortion = {-0.3, 0.1, 0.001, -0.001, 0.0};
  const Scene scene =
      scene_with(robot, base_from_upright_marker({2.1, 0.9, 0.25}, -0.5 * std::numbers::pi),
                 {.noise_sigma = 0});
  for (const Eigen::Vector2d& error : refined_error_px(scene, 0.7))
    EXPECT_LT(error.norm(), 0.03);
}

TEST(CornerRefinement, CornersThatWouldMoveFarAreKeptWithALargeCovariance) {
  const Scene scene =
      scene_with({}, base_from_upright_marker({1.5, 0.0, 0.1}, std::numbers::pi), {});
  const CameraModel camera{scene.robot.camera};
  const Corners far_off = pulled_inwards(scene.true_raw_px, 2.0);
  const RefinementConfig config{.max_move_px = 1.0};

  const MeasuredCorners corners =
      refine_corners(scene.image, camera, far_off, pattern_of(kId), config);

  EXPECT_FALSE(corners.refined);
  EXPECT_EQ(corners.ideal_px[0], far_off[0]);
  EXPECT_NEAR(corners.covariance(0, 0), 0.64, 1e-12);
}

TEST(CornerRefinement, AcrossAShadowCornersAreKeptWithALargeCovariance) {
  const Scene scene =
      scene_with({}, base_from_upright_marker({1.5, 0.0, 0.2}, std::numbers::pi), {});
  const double middle = 0.5 * (scene.true_raw_px[0].x() + scene.true_raw_px[1].x());
  cv::Mat shaded = scene.image.colRange(static_cast<int>(middle), scene.image.cols);
  shaded *= 0.5;
  const Corners corners_px = pulled_inwards(scene.true_raw_px, 0.7);
  const MeasuredCorners corners =
      refine_corners(scene.image, CameraModel{scene.robot.camera}, corners_px, pattern_of(kId), {});
  EXPECT_FALSE(corners.refined);
  EXPECT_EQ(corners.ideal_px[2], corners_px[2]);
}

TEST(CornerRefinement, UnevenLightDoesNotMoveCorners) {
  Scene scene = scene_with({}, base_from_upright_marker({1.5, 0.0, 0.2}, std::numbers::pi), {});
  for (int column = 0; column < scene.image.cols; ++column)
    scene.image.col(column) *= 0.5 + 0.5 * column / scene.image.cols;
  for (const Eigen::Vector2d& error : refined_error_px(scene, 0.7))
    EXPECT_LT(error.norm(), 0.03);
}

TEST(CornerRefinement, AnotherMarkersPatternDoesNotFit) {
  const Scene scene =
      scene_with({}, base_from_upright_marker({1.5, 0.0, 0.2}, std::numbers::pi), {});
  EXPECT_FALSE(refine_corners(scene.image, CameraModel{scene.robot.camera}, scene.true_raw_px,
                              pattern_of(kId + 1), {})
                   .refined);
}

TEST(CornerRefinement, NothingIsRefinedWhereThereIsNoEdge) {
  const cv::Mat flat(480, 640, CV_8UC1, cv::Scalar{120});
  const Corners corners{Eigen::Vector2d{100, 100}, Eigen::Vector2d{200, 100},
                        Eigen::Vector2d{200, 200}, Eigen::Vector2d{100, 200}};
  EXPECT_FALSE(
      refine_corners(flat, CameraModel{CameraConfig{}}, corners, pattern_of(kId), {}).refined);
}

TEST(CornerRefinement, CornersOutsideTheImageAreHarmless) {
  const cv::Mat flat(480, 640, CV_8UC1, cv::Scalar{120});
  const Corners corners{Eigen::Vector2d{-50, -50}, Eigen::Vector2d{700, -20},
                        Eigen::Vector2d{690, 500}, Eigen::Vector2d{-10, 490}};
  EXPECT_FALSE(
      refine_corners(flat, CameraModel{CameraConfig{}}, corners, pattern_of(kId), {}).refined);
}

}  // namespace
}  // namespace waymark
