// SPDX-License-Identifier: BSD-3-Clause
#include "viewer/core/layers/map_layers.hpp"

#include "unit/viewer/drawn_scene.hpp"
#include "unit/viewer/found_on_picture.hpp"

#include <gtest/gtest.h>

#include <numbers>

namespace waymark::viewer {
namespace {

TEST(DrawCells, WallsOfOneCellStayVisibleWhereSeveralCellsShareAPixel) {
  GridMap map = room(0, 0, 100, 100);
  map.occupancy_percent.setTo(0);
  for (int column = 7; column < map.occupancy_percent.cols; column += 101)
    map.occupancy_percent.col(column).setTo(100);
  const MapViewport view{.box = {0, 0, 100, 100}, .px_per_m = 5.3};  // 3.8 cells per pixel
  cv::Mat panel(view.size_px(), CV_8UC3);
  draw_cells(panel, view, map, occupancy_colour());
  int walls = 0;
  for (int x = 1; x < panel.cols; ++x) {
    const auto is_wall = [&](int column) {
      return panel.at<Colour>(100, column) == to_colour(palette::kOccupied);
    };
    walls += is_wall(x) && !is_wall(x - 1) ? 1 : 0;
  }
  EXPECT_EQ(walls, 20);
}

TEST(DrawCells, EachPixelHasTheCellBelowItsCentre) {
  const GridMap map = drawn_map({"#.", ".#", "#."});
  const MapViewport view{.view_from_map = {0, 0, std::numbers::pi / 2},
                         .box = {-3 * kCell_m, 0, 0, 2 * kCell_m},
                         .px_per_m = 4 / kCell_m};
  cv::Mat panel(view.size_px(), CV_8UC3);
  draw_cells(panel, view, map, occupancy_colour());
  ASSERT_EQ(panel.size(), (cv::Size{12, 8}));
  const GridMap turned = drawn_map({".#.", "#.#"});  // counter-clockwise by a quarter
  for (int y = 0; y < panel.rows; ++y) {
    for (int x = 0; x < panel.cols; ++x) {
      const bool is_wall = turned.occupancy_percent(1 - y / 4, x / 4) == 100;
      EXPECT_EQ(panel.at<Colour>(y, x), to_colour(is_wall ? palette::kOccupied : palette::kFree))
          << x << " " << y;
    }
  }
}

/// A picture of 2 m x 2 m around the map's origin, with 200 x 200 pixels, map x to the right.
struct Picture {
  MapViewport view{.box = {-1.0, -1.0, 1.0, 1.0}, .px_per_m = 100.0};
  cv::Mat_<Colour> pixels = cv::Mat_<Colour>(200, 200, to_colour(palette::kPage));

  bool has(const cv::Scalar& colour, int x, int y) const {
    return pixels(y, x) == to_colour(colour);
  }
};

TEST(StrokesAt, AreFinerAtSmallScalesButStayVisible) {
  const StrokeWidths full{};
  EXPECT_EQ(strokes_at(1000.0).health_px, full.health_px);
  const StrokeWidths fine = strokes_at(40.0);
  EXPECT_EQ(fine.health_px, full.health_px / 2);
  EXPECT_EQ(fine.true_px, full.true_px / 2);
  EXPECT_GT(strokes_at(0.1).odometry_px, 1);
}

TEST(DrawPaths, OdometryIsDrawnOnlyWhereItIsIncluded) {
  const PageContent content{.odometry_in_map = {{.frame_from_base = {-0.5, 0.5, 0.0}},
                                                {.frame_from_base = {0.5, 0.5, 0.0}}}};
  for (const OdometryPath odometry : {OdometryPath::kIncluded, OdometryPath::kLeftOut}) {
    Picture picture;
    draw_paths(picture.pixels, picture.view, content, {}, odometry);
    EXPECT_EQ(picture.has(palette::kOdometry, 100, 50), odometry == OdometryPath::kIncluded);
  }
}

TEST(DrawPlates, AMarkerIsABarAlongItsWallWithALineTowardsItsFront) {
  Picture picture;
  const Landmark facing_up{.map_from_marker = {0.5, 0.2, std::numbers::pi / 2},
                           .state = LandmarkState::kConfirmed};
  draw_plates(picture.pixels, picture.view, {facing_up}, 0.4, 6);
  const cv::Rect box = box_of_colour(picture.pixels, palette::kMarker);
  EXPECT_NEAR(box.x, 130, 4) << "0.2 m to the left of its middle";
  EXPECT_NEAR(box.br().x, 170, 4);
  EXPECT_TRUE(picture.has(palette::kMarker, 150, 80 - 9)) << "its front";
  EXPECT_FALSE(picture.has(palette::kMarker, 150, 80 + 9)) << "its back";
}

TEST(DrawEnds, TheStartIsARingAndTheEndAnArrowHeadAlongTheHeading) {
  Picture picture;
  draw_ends(
      picture.pixels, picture.view,
      {{.map_from_base = {-0.6, 0.0, 0.0}}, {.map_from_base = {0.4, 0.0, std::numbers::pi / 2}}});
  EXPECT_TRUE(picture.has(palette::kEstimated, 40 + 11, 100)) << "the ring";
  EXPECT_TRUE(picture.has(palette::kPage, 40, 100)) << "its middle";
  EXPECT_TRUE(picture.has(palette::kEstimated, 140, 100 - 15)) << "the arrow's tip";
  EXPECT_FALSE(picture.has(palette::kEstimated, 140, 100 + 13)) << "its notch";
  EXPECT_TRUE(picture.has(palette::kEstimated, 140 - 13, 100 + 12)) << "its left wing";
  EXPECT_TRUE(picture.has(palette::kEstimated, 140 + 13, 100 + 12)) << "its right wing";
}

TEST(DrawParticles, EachParticleIsADot) {
  Picture picture;
  draw_particles(picture.pixels, picture.view, {{0.5, 0.5, 0.0}, {-0.5, 0.5, 1.0}});
  EXPECT_EQ(spots_of_colour(picture.pixels, palette::kParticle).size(), 2U);
  EXPECT_TRUE(picture.has(palette::kParticle, 150, 50));
  EXPECT_TRUE(picture.has(palette::kParticle, 50, 50));
}

}  // namespace
}  // namespace waymark::viewer
