// SPDX-License-Identifier: BSD-3-Clause
#include "common/robot/camera_model.hpp"

#include "common/random/random.hpp"

#include <gtest/gtest.h>
#include <opencv2/calib3d.hpp>

#include <cmath>

namespace waymark {
namespace {

CameraConfig bent_camera() {
  CameraConfig camera;
  camera.fy_px = 541.0;
  camera.distortion = {-0.28, 0.09, 0.0012, -0.0007, 0.01};
  return camera;
}

Eigen::Vector2d projected_by_opencv(const CameraConfig& camera, const Eigen::Vector3d& point) {
  const cv::Matx33d matrix{camera.fx_px, 0, camera.cx_px, 0, camera.fy_px, camera.cy_px, 0, 0, 1};
  std::vector<cv::Point2d> pixels;
  cv::projectPoints(std::vector{cv::Point3d{point.x(), point.y(), point.z()}}, cv::Vec3d{},
                    cv::Vec3d{}, matrix, camera.distortion, pixels);
  return {pixels[0].x, pixels[0].y};
}

TEST(CameraModel, RawPixelsAreWhatOpenCvProjects) {
  const CameraModel camera{bent_camera()};
  Random random{1};
  for (int i = 0; i < 50; ++i) {
    const Eigen::Vector3d point{random.uniform(-1, 1), random.uniform(-0.8, 0.8),
                                random.uniform(1.7, 4)};
    const Eigen::Vector2d raw_px = camera.raw_from_ideal(camera.project(point));
    EXPECT_LT((raw_px - projected_by_opencv(bent_camera(), point)).norm(), 1e-9);
  }
}

TEST(CameraModel, UndistortingAndDistortingGivesTheSamePixel) {
  const CameraModel camera{bent_camera()};
  for (const double u : {0.0, 100.0, 319.5, 639.0}) {
    for (const double v : {0.0, 240.0, 479.0}) {
      const Eigen::Vector2d raw_px{u, v};
      EXPECT_LT((camera.raw_from_ideal(camera.ideal_from_raw(raw_px)) - raw_px).norm(), 1e-6);
    }
  }
}

TEST(CameraModel, AStrongPincushionLensIsInverted) {
  CameraConfig config;
  config.fx_px = config.fy_px = 320.0;
  config.distortion = {1.0, 0.5, 0.01, -0.02, 0.0};
  const CameraModel camera{config};
  Random random{1};
  for (int i = 0; i < 200; ++i) {
    const Eigen::Vector2d raw_px{random.uniform(0, 639), random.uniform(0, 479)};
    EXPECT_LT((camera.raw_from_ideal(camera.ideal_from_raw(raw_px)) - raw_px).norm(), 1e-6)
        << raw_px.transpose();
  }
}

TEST(CameraModel, WhereALensCannotBeInvertedThereIsNoIdealPixel) {
  CameraConfig config;
  config.fx_px = config.fy_px = 250.0;
  config.distortion = {-0.3, 0.0, 0.0, 0.0, 0.0};
  const CameraModel camera{config};
  // The largest radius that has an inverse is 250 px * 0.703, at r = 1 / sqrt(0.9).
  EXPECT_TRUE(camera.ideal_from_raw({config.cx_px + 175.0, config.cy_px}).allFinite());
  EXPECT_LT(camera.ideal_from_raw({config.cx_px + 175.0, config.cy_px}).x(),
            config.cx_px + 250.0 / std::sqrt(0.9));
  EXPECT_TRUE(camera.ideal_from_raw({config.cx_px + 176.0, config.cy_px}).hasNaN());
  EXPECT_TRUE(camera.ideal_from_raw({0.0, 0.0}).hasNaN());
}

TEST(CameraModel, JacobianMatchesDifferences) {
  const CameraModel camera{bent_camera()};
  const Eigen::Vector3d point{0.4, -0.3, 2.2};
  constexpr double kStepM = 1e-6;
  for (int axis = 0; axis < 3; ++axis) {
    const Eigen::Vector3d step = kStepM * Eigen::Vector3d::Unit(axis);
    const Eigen::Vector2d difference =
        (camera.project(point + step) - camera.project(point - step)) / (2.0 * kStepM);
    EXPECT_LT((difference - camera.projection_jacobian(point).col(axis)).norm(), 1e-5);
  }
}

}  // namespace
}  // namespace waymark
