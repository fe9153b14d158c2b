// SPDX-License-Identifier: BSD-3-Clause
#include "sim/core/camera/renderer.hpp"

#include "common/geometry/angle.hpp"
#include "sim/core/world/mjcf.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <opencv2/aruco.hpp>
#include <opencv2/imgproc.hpp>

#include <cmath>
#include <numeric>

namespace waymark {
namespace {

constexpr Pinhole kPinhole{320, 240, 200.0, 159.5, 119.5};

/// A world, its physics and a renderer for it.
struct Scene {
  Scene(const WorldConfig& world_config, const MarkerLayoutConfig& markers, PlatePrint plate_print,
        const Pinhole& pinhole = kPinhole)
      : world{build_world(world_config, markers, plate_size_m({}), 1)},
        physics{mjcf(pinhole)},
        renderer{world, {}, plate_print, pinhole, physics} {}

  std::string mjcf(const Pinhole& pinhole) const {
    MjcfOptions options{};
    options.plate_size_m = plate_size_m({});
    options.picture_width_px = pinhole.width_px;
    options.picture_height_px = pinhole.height_px;
    options.world_from_start = {1.0, 0.0, 0.0};
    return to_mjcf(world, {}, options);
  }

  World world;
  Physics physics;
  Renderer renderer;
};

struct Sightings {
  std::vector<int> ids{};
  std::vector<std::vector<cv::Point2f>> corners{};
};

Sightings detect(const cv::Mat& rgb) {
  Sightings sightings;
  cv::Mat grey;
  cv::cvtColor(rgb, grey, cv::COLOR_RGB2GRAY);
  const auto parameters = cv::aruco::DetectorParameters::create();
  parameters->cornerRefinementMethod = cv::aruco::CORNER_REFINE_SUBPIX;
  cv::aruco::detectMarkers(grey, cv::aruco::getPredefinedDictionary(cv::aruco::DICT_6X6_250),
                           sightings.corners, sightings.ids, parameters);
  return sightings;
}

/// A camera in front of a marker, looking at its wall.
Eigen::Isometry3d looking_at(const MarkerPlate& marker, double distance_m,
                             const Eigen::Vector3d& offset_m = {0.0, 0.0, 0.0}) {
  CameraConfig camera{};
  const Eigen::Vector3d facing{std::cos(marker.yaw_rad), std::sin(marker.yaw_rad), 0.0};
  const Eigen::Vector3d position = marker.centre_m + distance_m * facing + offset_m;
  camera.x_m = position.x();
  camera.y_m = position.y();
  camera.z_m = position.z();
  camera.yaw_rad = wrap_angle(marker.yaw_rad + std::numbers::pi);
  return camera.base_from_camera();
}

cv::Point2d project(const Pinhole& pinhole, const Eigen::Isometry3d& world_from_camera,
                    const Eigen::Vector3d& point_in_world) {
  const Eigen::Vector3d point = world_from_camera.inverse() * point_in_world;
  return {pinhole.cx_px + pinhole.focal_px * point.x() / point.z(),
          pinhole.cy_px + pinhole.focal_px * point.y() / point.z()};
}

cv::Point2d mean_of(const std::vector<cv::Point2f>& corners) {
  const cv::Point2f sum = std::accumulate(corners.begin(), corners.end(), cv::Point2f{});
  return cv::Point2d{sum} / static_cast<double>(corners.size());
}

TEST(Renderer, ManyMarkersShowTheirOwnIds) {
  WorldConfig world{};
  world.length_m = 246.0;
  MarkerLayoutConfig markers{};
  markers.last_m = 240.0;  // 60 stations: 120 markers
  Scene scene{world, markers, PlatePrint::kMarkers};
  ASSERT_EQ(scene.world.markers.size(), 120U);

  for (const MarkerPlate& marker : scene.world.markers) {
    const Sightings seen = detect(scene.renderer.render(looking_at(marker, 1.0)));
    EXPECT_THAT(seen.ids, ::testing::ElementsAre(marker.id)) << "at x " << marker.centre_m.x();
  }
}

TEST(Renderer, PlatesOfRepeatedIdsShowTheirIds) {
  MarkerLayoutConfig markers{};
  markers.last_m = 8.0;
  markers.ids = {9, 9, 5, 9};
  Scene scene{{}, markers, PlatePrint::kMarkers};
  for (const MarkerPlate& marker : scene.world.markers) {
    const Sightings seen = detect(scene.renderer.render(looking_at(marker, 1.0)));
    EXPECT_THAT(seen.ids, ::testing::ElementsAre(marker.id));
  }
}

TEST(Renderer, BlankPlatesHaveNoIds) {
  Scene scene{{}, {}, PlatePrint::kBlank};
  EXPECT_TRUE(detect(scene.renderer.render(looking_at(scene.world.markers[0], 1.0))).ids.empty());
}

TEST(Renderer, PixelsFollowThePinholeModel) {
  // An off-centre principal point, and markers away from the middle. Corners found one by one are
  // biased towards the marker's centre, their mean is not.
  const Pinhole pinhole{640, 480, 500.0, 300.0, 260.0};
  Scene scene{{}, {}, PlatePrint::kMarkers, pinhole};
  const MarkerPlate& marker = scene.world.markers[2];
  for (const Eigen::Vector3d& offset_m :
       {Eigen::Vector3d{0.0, 0.0, 0.0}, {0.31, 0.0, 0.12}, {-0.23, 0.0, -0.1}}) {
    const Eigen::Isometry3d world_from_camera = looking_at(marker, 1.5, offset_m);
    const Sightings seen = detect(scene.renderer.render(world_from_camera));
    ASSERT_THAT(seen.ids, ::testing::ElementsAre(marker.id));
    const cv::Point2d expected = project(pinhole, world_from_camera, marker.centre_m);
    EXPECT_NEAR(mean_of(seen.corners[0]).x, expected.x, 0.1);  // half a pixel would be wrong
    EXPECT_NEAR(mean_of(seen.corners[0]).y, expected.y, 0.1);
    const double side_px = cv::norm(seen.corners[0][1] - seen.corners[0][0]);
    EXPECT_NEAR(side_px, pinhole.focal_px * 0.4 / 1.5, 2.0);
  }
}

/// Row at which a column changes from black to white, computed from the sum of its grey levels
/// between the two rows; exact if every pixel is the mean over its area.
double edge_row(const cv::Mat& grey, int column, int black_row, int white_row) {
  const double black = grey.at<std::uint8_t>(black_row, column);
  const double white = grey.at<std::uint8_t>(white_row, column);
  const int step = white_row > black_row ? 1 : -1;
  double black_rows = 0.5;
  for (int row = black_row + step; row != white_row; row += step)
    black_rows += (white - grey.at<std::uint8_t>(row, column)) / (white - black);
  return black_row + step * black_rows;
}

TEST(Renderer, EdgesAlongPixelRowsAreUnbiased) {
  // The default camera looks along the corridor and sees the lower edges of all markers within the
  // same row of pixels: an error there is the same for every marker.
  const RobotConfig robot{};
  const Pinhole pinhole{640, 480, robot.camera.fx_px, robot.camera.cx_px, robot.camera.cy_px};
  Scene scene{{}, {}, PlatePrint::kMarkers, pinhole};
  for (const std::size_t i : {2U, 3U}) {  // left wall, right wall
    const Eigen::Vector3d centre = scene.world.markers[i].centre_m;
    for (const double distance_m : {1.9, 2.1, 2.3, 2.5, 2.7, 2.9}) {
      Eigen::Isometry3d world_from_camera = robot.camera.base_from_camera();
      world_from_camera.translation().x() = centre.x() - distance_m;
      cv::Mat grey;
      cv::cvtColor(scene.renderer.render(world_from_camera), grey, cv::COLOR_RGB2GRAY);
      const auto lower = [&](double x_m) {
        return project(pinhole, world_from_camera, centre + Eigen::Vector3d{x_m, 0.0, -0.2});
      };
      const cv::Point2d near = lower(-0.2), far = lower(0.2);
      constexpr int kMargin_px = 3;
      const int first = static_cast<int>(std::ceil(std::min(near.x, far.x))) + kMargin_px;
      const int last = static_cast<int>(std::floor(std::max(near.x, far.x))) - kMargin_px;
      double sum_px = 0.0;
      for (int column = first; column <= last; ++column) {
        const double row = near.y + (far.y - near.y) * (column - near.x) / (far.x - near.x);
        const int middle = static_cast<int>(std::lround(row));
        sum_px += edge_row(grey, column, middle - kMargin_px, middle + kMargin_px) - row;
      }
      EXPECT_LT(std::abs(sum_px) / (last - first + 1), 0.004)
          << i << " from " << distance_m << " m";
    }
  }
}

TEST(Renderer, OccludersOfAPlateAreNotPrintedOn) {
  WorldConfig world{};
  BoxConfig box{};
  box.x_m = 4.0;
  box.y_m = 0.5;
  box.length_m = 0.1;
  box.width_m = 0.1;
  box.height_m = 1.0;
  world.boxes = {box};
  Scene scene{world, {}, PlatePrint::kMarkers};
  const MarkerPlate& marker = scene.world.markers[0];
  const Eigen::Isometry3d world_from_camera = looking_at(marker, 1.2);
  const cv::Mat picture = scene.renderer.render(world_from_camera);
  cv::Mat grey;
  cv::cvtColor(picture, grey, cv::COLOR_RGB2GRAY);
  // The box covers the middle of the plate: one level throughout.
  const cv::Mat on_box = grey(cv::Rect{150, 80, 20, 80});
  double low = 0.0, high = 0.0;
  cv::minMaxLoc(on_box, &low, &high);
  EXPECT_EQ(low, high);
  // Beside it the plate is seen: black and white.
  cv::minMaxLoc(grey(cv::Rect{112, 80, 28, 80}), &low, &high);
  EXPECT_LT(low, 40.0);
  EXPECT_GT(high, 200.0);
}

TEST(Renderer, CornerZeroIsThePrintsTopLeft) {
  Scene scene{{}, {}, PlatePrint::kMarkers};
  for (const std::size_t i : {0U, 1U}) {  // left wall, right wall
    const Sightings seen = detect(scene.renderer.render(looking_at(scene.world.markers[i], 1.0)));
    ASSERT_EQ(seen.corners.size(), 1U);
    const cv::Point2d centre = mean_of(seen.corners[0]);
    EXPECT_LT(seen.corners[0][0].x, centre.x);
    EXPECT_LT(seen.corners[0][0].y, centre.y);
  }
}

TEST(Renderer, FloorWallsAndEndLookDifferent) {
  Scene scene{{}, {}, PlatePrint::kMarkers};
  CameraConfig camera{};
  camera.x_m = 46.0;
  camera.z_m = 1.0;
  const cv::Mat picture = scene.renderer.render(camera.base_from_camera()).clone();
  std::vector<int> greys;
  for (const cv::Point at : {cv::Point{160, 235}, {160, 5}, {5, 120}, {315, 120}, {160, 120}})
    greys.push_back(picture.at<cv::Vec3b>(at)[1]);
  for (std::size_t i = 0; i < greys.size(); ++i) {
    EXPECT_GT(greys[i], 40);
    EXPECT_LT(greys[i], 230);
    for (std::size_t j = 0; j < i; ++j)
      EXPECT_GT(std::abs(greys[i] - greys[j]), 5) << i << " " << j;
  }
}

TEST(Renderer, TheRobotIsNotInItsOwnImages) {
  Scene scene{{}, {}, PlatePrint::kMarkers};  // the robot stands at x = 1 m
  CameraConfig camera{};
  camera.x_m = 0.3;
  camera.z_m = 0.2;
  camera.pitch_rad = 0.2;
  const cv::Mat picture = scene.renderer.render(camera.base_from_camera());
  EXPECT_EQ(picture.at<cv::Vec3b>(200, 160), picture.at<cv::Vec3b>(235, 160));  // floor only
  EXPECT_EQ(picture.at<cv::Vec3b>(180, 160), picture.at<cv::Vec3b>(235, 160));
}

TEST(Renderer, TheSamePoseGivesTheSameBytes) {
  Scene scene{{}, {}, PlatePrint::kMarkers};
  const Eigen::Isometry3d here = looking_at(scene.world.markers[0], 1.0);
  const cv::Mat first = scene.renderer.render(here).clone();
  scene.renderer.render(looking_at(scene.world.markers[5], 1.0));
  EXPECT_EQ(cv::norm(first, scene.renderer.render(here)), 0.0);
}

}  // namespace
}  // namespace waymark
