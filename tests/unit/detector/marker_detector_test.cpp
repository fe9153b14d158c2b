// SPDX-License-Identifier: BSD-3-Clause
#include "detector/core/marker_detector.hpp"

#include "common/geometry/angle.hpp"
#include "support/marker_image.hpp"

#include <Eigen/Cholesky>
#include <gtest/gtest.h>

#include <cmath>

namespace waymark {
namespace {

using testing::base_from_upright_marker;
using testing::PlacedMarker;
using testing::render_markers;

PlacedMarker placed(const RobotConfig& robot, int id, const Eigen::Isometry3d& base_from_marker) {
  return {id, robot.camera.base_from_camera().inverse() * base_from_marker};
}

/// A marker on the left wall of a corridor 2 m wide, seen from the middle of it.
Eigen::Isometry3d on_left_wall(double ahead_of_camera_m) {
  return base_from_upright_marker({RobotConfig{}.camera.x_m + ahead_of_camera_m, 1.0, 0.25},
                                  radians(-90));
}

std::vector<MarkerDetection> detect(const RobotConfig& robot,
                                    const std::vector<PlacedMarker>& markers,
                                    std::uint64_t seed = 1) {
  return MarkerDetector{robot, {}}.detect(render_markers(robot, markers, {}, Random{seed}));
}

double angle_between(const Eigen::Isometry3d& a, const Eigen::Isometry3d& b) {
  return Eigen::Quaterniond{a.linear()}.angularDistance(Eigen::Quaterniond{b.linear()});
}

TEST(MarkerDetector, AMarkerAheadHasItsPoseInTheBaseFrame) {
  RobotConfig robot;
  robot.camera.pitch_rad = radians(4);
  robot.camera.yaw_rad = radians(-7);
  const Eigen::Isometry3d base_from_marker =
      base_from_upright_marker({2.0, 0.1, 0.3}, radians(150));

  const auto detections = detect(robot, {placed(robot, 0, base_from_marker)});

  ASSERT_EQ(detections.size(), 1U);
  EXPECT_EQ(detections[0].id, 0);  // 0 is a valid id
  EXPECT_LT((detections[0].base_from_marker.translation() - base_from_marker.translation()).norm(),
            0.003);
  EXPECT_LT(angle_between(detections[0].base_from_marker, base_from_marker), radians(0.3));
  EXPECT_GT(detections[0].other_reprojection_error_px, detections[0].reprojection_error_px);
  EXPECT_NEAR(detections[0].width_px, 530.0 * 0.4 / 1.92 * std::cos(radians(30)), 6.0);
}

/// Figures of the detector's specification, on a small sample; the benchmark has the large one.
TEST(MarkerDetector, RangeAndBearingInACorridor) {
  const RobotConfig robot;
  const Eigen::Vector3d camera_in_base = robot.camera.base_from_camera().translation();
  for (const double ahead_m : {2.0, 3.0, 3.5}) {
    constexpr int kTrials = 8;
    double range_squares = 0.0;
    double bearing_squares = 0.0;
    for (int i = 0; i < kTrials; ++i) {
      const Eigen::Isometry3d truth = on_left_wall(ahead_m + 0.007 * i);
      const auto detections = detect(robot, {placed(robot, 20 + i, truth)}, 100U + i);
      ASSERT_EQ(detections.size(), 1U) << ahead_m << " m";
      EXPECT_EQ(detections[0].id, 20 + i);
      const Eigen::Vector3d seen = detections[0].base_from_marker.translation() - camera_in_base;
      const Eigen::Vector3d expected = truth.translation() - camera_in_base;
      range_squares += std::pow(seen.norm() - expected.norm(), 2) / kTrials;
      bearing_squares +=
          std::pow(std::atan2(seen.y(), seen.x()) - std::atan2(expected.y(), expected.x()), 2) /
          kTrials;
    }
    EXPECT_LT(std::sqrt(range_squares), 0.005) << ahead_m << " m";
    EXPECT_LT(degrees(std::sqrt(bearing_squares)), 0.01) << ahead_m << " m";
  }
}

TEST(MarkerDetector, PoseErrorsInRenderedImagesMatchTheirCovariance) {
  const RobotConfig robot;
  constexpr int kTrials = 40;
  double nees = 0.0;
  for (int i = 0; i < kTrials; ++i) {
    const Eigen::Isometry3d truth = on_left_wall(2.1 + 0.03 * i);
    const auto detections = detect(robot, {placed(robot, i, truth)}, 200U + i);
    ASSERT_EQ(detections.size(), 1U);
    const MarkerDetection& seen = detections[0];
    const Eigen::AngleAxisd turn{seen.base_from_marker.linear() * truth.linear().transpose()};
    Eigen::Matrix<double, 6, 1> error;
    error << seen.base_from_marker.translation() - truth.translation(), turn.angle() * turn.axis();
    nees += error.dot(seen.covariance_in_base.ldlt().solve(error)) / kTrials;
  }
  // Ideally 6; but corner errors in images are not quite Gaussian and not quite independent.
  EXPECT_GT(nees, 2.0);
  EXPECT_LT(nees, 12.0);
}

TEST(MarkerDetector, ALensDoesNotChangeThePose) {
  RobotConfig robot;
  robot.camera.distortion = {-0.3, 0.1, 0.001, -0.001, 0.0};
  const Eigen::Isometry3d truth = on_left_wall(2.2);

  const auto detections = detect(robot, {placed(robot, 11, truth)});

  ASSERT_EQ(detections.size(), 1U);
  EXPECT_LT((detections[0].base_from_marker.translation() - truth.translation()).norm(), 0.005);
  EXPECT_LT(angle_between(detections[0].base_from_marker, truth), radians(0.3));
}

TEST(MarkerDetector, OnlyMarkersOfTheConfiguredIdsAreReported) {
  RobotConfig robot;
  robot.markers.ids = {0, 5};
  const auto detections =
      detect(robot, {placed(robot, 5, base_from_upright_marker({2, 0.4, 0.2}, radians(180))),
                     placed(robot, 6, base_from_upright_marker({2, -0.4, 0.2}, radians(180)))});
  ASSERT_EQ(detections.size(), 1U);
  EXPECT_EQ(detections[0].id, 5);
}

TEST(MarkerDetector, TwoMarkersOfOneIdAreTwoDetections) {
  const RobotConfig robot;
  const auto detections =
      detect(robot, {placed(robot, 3, base_from_upright_marker({2, 0.5, 0.2}, radians(180))),
                     placed(robot, 3, base_from_upright_marker({2, -0.5, 0.2}, radians(180)))});
  ASSERT_EQ(detections.size(), 2U);
  EXPECT_GT(detections[0].base_from_marker.translation().y(), 0.0);
  EXPECT_LT(detections[1].base_from_marker.translation().y(), 0.0);
}

/// A marker ahead, whose white quiet zone of one module hangs on a dark wall.
cv::Mat marker_on_dark_wall(const RobotConfig& robot, double ahead_m) {
  return render_markers(
      robot, {placed(robot, 4, base_from_upright_marker({ahead_m, 0.1, 0.2}, radians(165)))},
      {.wall = 15.0, .quiet_zone_modules = 1.0}, Random{7});
}

TEST(MarkerDetector, AMarkerOnADarkWallIsNotMistakenForItsQuietZone) {
  const RobotConfig robot;
  for (const double ahead_m : {1.0, 1.5, 2.0, 2.5, 3.0, 4.0}) {
    const auto detections = MarkerDetector{robot, {}}.detect(marker_on_dark_wall(robot, ahead_m));
    ASSERT_EQ(detections.size(), 1U) << ahead_m << " m";
    EXPECT_NEAR(detections[0].base_from_marker.translation().x(), ahead_m, 0.01 * ahead_m);
  }
}

TEST(MarkerDetector, AprilTagsAreReadToo) {
  RobotConfig robot;
  robot.markers.dictionary = "DICT_APRILTAG_36h11";
  const auto detections = detect(robot, {placed(robot, 42, on_left_wall(3.0))});
  ASSERT_EQ(detections.size(), 1U);
  EXPECT_EQ(detections[0].id, 42);
}

TEST(MarkerDetector, ABlankImageHasNoMarkers) {
  EXPECT_TRUE(detect({}, {}).empty());
}

TEST(MarkerDetector, TheSameImageGivesTheSameNumbers) {
  const RobotConfig robot;
  const cv::Mat image = render_markers(robot, {placed(robot, 1, on_left_wall(2.5))}, {}, Random{9});
  const MarkerDetector detector{robot, {}};
  const auto first = detector.detect(image);
  const auto second = detector.detect(image.clone());
  ASSERT_EQ(first.size(), 1U);
  ASSERT_EQ(second.size(), 1U);
  EXPECT_EQ(first[0].base_from_marker.matrix(), second[0].base_from_marker.matrix());
  EXPECT_EQ(first[0].covariance_in_base, second[0].covariance_in_base);
}

TEST(MarkerDetector, CalibrationErrorsAddToTheCovariance) {
  const RobotConfig robot;
  const cv::Mat image = render_markers(
      robot, {placed(robot, 1, base_from_upright_marker({2.076, 0, 0.103}, radians(180)))}, {},
      Random{9});
  MarkerDetectorConfig config;
  const auto exact = MarkerDetector{robot, config}.detect(image);
  config.calibration_error = {.range_rate = 0.01, .bearing_rad = 0.005, .orientation_rad = 0.02};
  const auto floored = MarkerDetector{robot, config}.detect(image);

  ASSERT_EQ(exact.size(), 1U);
  ASSERT_EQ(floored.size(), 1U);
  const Eigen::Matrix<double, 6, 1> added =
      (floored[0].covariance_in_base - exact[0].covariance_in_base).diagonal();
  EXPECT_NEAR(std::sqrt(added(0)), 0.02, 1e-4);  // 1 % of 2 m, forward
  EXPECT_NEAR(std::sqrt(added(1)), 0.01, 1e-4);  // 5 mrad at 2 m, sideways
  EXPECT_NEAR(std::sqrt(added(5)), 0.02, 1e-4);
}

}  // namespace
}  // namespace waymark
