// SPDX-License-Identifier: BSD-3-Clause
#include "unit/viewer/drawn_scene.hpp"
#include "unit/viewer/found_on_picture.hpp"
#include "viewer/core/drawing/palette.hpp"
#include "viewer/core/layers/map_layers.hpp"
#include "viewer/core/layers/marker_labels.hpp"
#include "viewer/core/painters/layer_painter.hpp"
#include "viewer/core/painters/map_painter.hpp"
#include "viewer/core/painters/plain_painter.hpp"
#include "viewer/core/painters/scan_painter.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

namespace waymark::viewer {
namespace {

using ::testing::AllOf;
using ::testing::Ge;
using ::testing::Le;
using ::testing::SizeIs;

constexpr MapPageStyle kStyle{};

Scene scene_of(const GridMap& map) {
  Scene scene;
  if (!map.empty()) put_cells(scene.map, map);
  return scene;
}

bool contains_colour(const cv::Mat& image, const cv::Scalar& colour) {
  return count_pixels(image, colour) > 0;
}

TEST(PaintMap, ALongCorridorIsFoldedIntoReadableStrips) {
  const Scene scene = corridor_scene(50.0);

  const MapPage page = lay_out(content_of(scene), kStyle);

  EXPECT_THAT(page.strips, SizeIs(AllOf(Ge(2U), Le(4U))));
  EXPECT_TRUE(page.overview);
  EXPECT_GE(page.strips.front().view.px_per_m, 110.0);
  EXPECT_LE(page.size_px.width, kStyle.page_width_px);
  EXPECT_LE(page.size_px.height, kStyle.page_height_px + 850);
}

TEST(PaintMap, StripsCoverTheWholeMap) {
  const PageContent content = content_of(corridor_scene(50.0));
  const MapPage page = lay_out(content, kStyle);
  const Box box = bounds(content, Se2{}, OdometryPath::kLeftOut);

  EXPECT_LT(page.strips.front().view.box.left_m, box.left_m);
  EXPECT_GT(page.strips.back().view.box.right_m, box.right_m);
  for (std::size_t i = 1; i < page.strips.size(); ++i)
    EXPECT_LT(page.strips[i].view.box.left_m, page.strips[i - 1].view.box.right_m);
  for (const Panel& strip : page.strips) {
    EXPECT_GE(strip.page_px.x, 0);
    EXPECT_LE(strip.page_px.br().x, page.size_px.width);
    EXPECT_LE(strip.page_px.br().y, page.legend_px.y);
  }
}

TEST(PaintMap, ShortCorridorsAndSquareRoomsStayInOneStrip) {
  EXPECT_THAT(lay_out(content_of(corridor_scene(10.0)), kStyle).strips, SizeIs(1));
  EXPECT_THAT(lay_out(content_of(scene_of(room(-2, -2, 3, 3))), kStyle).strips, SizeIs(1));
  EXPECT_THAT(lay_out(content_of(scene_of(room(-1, -1, 49, 49))), kStyle).strips, SizeIs(1));
}

TEST(PaintMap, AVerticalCorridorIsDrawnHorizontally) {
  const GridMap standing = room(-1, -1, 1, 49);
  EXPECT_NEAR(std::abs(view_from_map(standing).theta()), std::numbers::pi / 2, 1e-3);
  EXPECT_GT(lay_out(content_of(scene_of(standing)), kStyle).strips.size(), 1U);
  EXPECT_EQ(view_from_map(room(-1, -1, 49, 1)).theta(), 0.0);
}

TEST(PaintMap, EachElementHasItsColour) {
  const cv::Mat page = paint_map(corridor_scene(50.0), kStyle);
  for (const cv::Scalar& colour :
       {palette::kEstimated, palette::kTrue, palette::kOdometry, palette::kMarker,
        palette::kInitialising, palette::kDegenerate}) {
    EXPECT_TRUE(contains_colour(page, colour)) << colour;
  }
  EXPECT_FALSE(contains_colour(page, palette::kLost));
}

TEST(PaintMap, ShowsLostStretchesAndMovedMarkersInMapAndLegend) {
  Scene scene = corridor_scene(50.0);
  EXPECT_FALSE(contains_colour(paint_map(scene, kStyle), palette::kMoved));
  scene.estimates[1000].health = Health::kLost;
  scene.landmarks[3].state = LandmarkState::kMoved;
  const cv::Mat page = paint_map(scene, kStyle);
  EXPECT_TRUE(contains_colour(page, palette::kLost));
  EXPECT_TRUE(contains_colour(page, palette::kMoved));
}

TEST(PaintMap, TheLegendGrowsWithWhatIsDrawn) {
  const int height_px = paint_map(corridor_scene(50.0), kStyle).rows;
  Scene scene = corridor_scene(50.0);
  for (EstimatedPose& pose : scene.estimates)
    pose.weak_axis = WeakAxis{.direction = {1, 0, 0}, .source = WeakAxisSource::kNothing};
  scene.final_trajectory = {{scene.estimates.front().time, {0, 0, 0}},
                            {scene.estimates.back().time, {48, 0, 0}}};
  scene.landmarks[0].state = LandmarkState::kTentative;
  scene.landmarks[3].state = LandmarkState::kMoved;
  scene.estimates[1000].health = Health::kLost;
  const cv::Mat page = paint_map(scene, kStyle);
  EXPECT_GT(page.rows, height_px);
  EXPECT_LT(page.rows, height_px + 200);
}

TEST(PaintMap, TheFinalTrajectoryIsDashedOverTheOthers) {
  const MapViewport view{.box = {0, -1, 4, 1}, .px_per_m = 50.0};
  PageContent content;
  content.estimates = {{.map_from_base = {0, 0, 0}}, {.map_from_base = {4, 0, 0}}};
  content.final_in_map = {{{}, {0, 0, 0}}, {{}, {4, 0, 0}}};
  cv::Mat_<Colour> panel(100, 200, Colour{255, 255, 255});
  draw_paths(panel, view, content, {}, OdometryPath::kIncluded);
  int dashes = 0, gaps = 0;
  for (int x = 0; x < panel.cols; ++x) {
    dashes += panel(50, x) == to_colour(palette::kFinal) ? 1 : 0;
    gaps += panel(50, x) == to_colour(palette::kEstimated) ? 1 : 0;
  }
  EXPECT_GT(dashes, 60);
  EXPECT_GT(gaps, 30);
}

TEST(PaintMap, AnEmptySceneIsPainted) {
  const cv::Mat page = paint_map(Scene{}, kStyle);
  EXPECT_GE(page.cols, 800);
  EXPECT_FALSE(contains_colour(page, palette::kTrue)) << "no truth, no entry in the legend";
}

// OpenCV's warpAffine ends at 32767 pixels.
TEST(PaintMap, AMapOf40000CellsIsPainted) {
  const Scene scene = scene_of(room(-1, -1, 1999, 1));
  for (const int max_strips : {1, 8}) {
    const cv::Mat page = paint_map(scene, {.max_strips = max_strips});
    EXPECT_TRUE(contains_colour(page, occupancy_colour()(96, -1)));
  }
  EXPECT_FALSE(paint_marker_layer(scene.map.grid(), "long", kStyle).empty());
}

TEST(PaintMap, WithoutCellsTheFrameIsAroundMarkersAndPoses) {
  Scene scene;
  scene.landmarks = {{.id = 1, .map_from_marker = {500, 500, 0}},
                     {.id = 2, .map_from_marker = {504, 500, 0}}};
  const auto frame = [&] {
    return lay_out(content_of(scene), kStyle).strips.front().view.box;
  };
  EXPECT_LT(frame().left_m, 500.0);
  EXPECT_GT(frame().left_m, 490.0);
  EXPECT_GT(frame().right_m, 504.0);
  scene.landmarks.clear();
  scene.estimates = {{.map_from_base = {-300, 7, 0}}};
  EXPECT_LT(frame().left_m, -300.0);
  EXPECT_LT(frame().right_m, -290.0);
}

TEST(PaintMap, ASceneWithOneCellAndExtremeNumbersIsPainted) {
  EXPECT_FALSE(paint_map(scene_of(drawn_map({"#"})), kStyle).empty());

  Scene scene = corridor_scene(10.0);
  const Timestamp later = scene.estimates.back().time + Duration{1};
  scene.estimates.push_back({.time = later, .map_from_base = {1e300, -1e300, 0}});
  scene.estimates.back().covariance.diagonal() << 1e200, -1.0, 0.0;
  scene.final_trajectory = {{later, {1e300, std::nan(""), 0}}, {later, {0, -1e300, 0}}};
  scene.landmarks.push_back({.id = 1 << 30, .map_from_marker = {-1e12, 3, 0}});
  scene.particles.emplace_back(1e30, 0, 0);
  const cv::Mat page = paint_map(scene, kStyle);
  EXPECT_LE(page.cols, kStyle.page_width_px);
}

bool contains_path(const Box& box, const std::vector<EstimatedPose>& path) {
  return std::all_of(path.begin(), path.end(), [&box](const EstimatedPose& pose) {
    const Eigen::Vector2d& point = pose.map_from_base.translation();
    return point.x() > box.left_m && point.x() < box.right_m && point.y() > box.bottom_m &&
           point.y() < box.top_m;
  });
}

TEST(PaintMap, TheWholeEstimatedPathIsInTheFrame) {
  Scene scene = corridor_scene(10.0);
  for (int i = 1; i <= 100; ++i) {  // out of the mapped corridor, through its wall
    EstimatedPose pose = scene.estimates.back();
    pose.time += Duration{i * 100'000};
    pose.map_from_base = {8.0, 0.3 * i, 0.0};
    scene.estimates.push_back(pose);
  }
  const MapPage page = lay_out(content_of(scene), kStyle);
  ASSERT_THAT(page.strips, SizeIs(1));
  EXPECT_TRUE(contains_path(page.strips.front().view.box, scene.estimates));
}

TEST(PaintMap, DriftingOdometryIsDrawnInTheOverviewOnly) {
  Scene scene = corridor_scene(10.0);
  const MapPage before = lay_out(content_of(scene), kStyle);
  EXPECT_EQ(before.odometry_in_strips, OdometryPath::kIncluded);
  EXPECT_FALSE(before.overview);
  double along_m = 0.0;
  for (TimedPose& pose : scene.odometry) {
    along_m += 0.02;
    pose.frame_from_base = {along_m, 2.5 * along_m, 0.0};  // 20 m sideways
  }
  const MapPage page = lay_out(content_of(scene), kStyle);
  EXPECT_EQ(page.odometry_in_strips, OdometryPath::kLeftOut);
  ASSERT_TRUE(page.overview);
  EXPECT_GT(page.overview->view.box.top_m, 19.0);
  EXPECT_LT(page.strips.front().view.box.top_m, 3.0);
  EXPECT_GT(page.strips.front().view.px_per_m, 0.8 * before.strips.front().view.px_per_m);
}

/// Corridors of 2 m around a block of 200 m x 60 m, driven twice; every scan is degenerate.
Scene building_scene() {
  constexpr double kLength_m = 200.0, kWidth_m = 60.0, kStep_m = 0.1;
  Scene scene;
  GridMap map = room(-1.0, -1.0, kLength_m + 1.0, kWidth_m + 1.0);
  for (int row = 0; row < map.occupancy_percent.rows; ++row) {
    for (int column = 0; column < map.occupancy_percent.cols; ++column) {
      const Eigen::Vector2d cell = map.cell_centre_m(row, column);
      const double inside_m = std::min(
          {cell.x() - 1.0, kLength_m - 1.0 - cell.x(), cell.y() - 1.0, kWidth_m - 1.0 - cell.y()});
      if (inside_m > 0.0) map.occupancy_percent(row, column) = inside_m < kCell_m ? 96 : -1;
    }
  }
  put_cells(scene.map, map);
  const std::vector<Se2> corners{{0, 0, 0},
                                 {kLength_m, 0, std::numbers::pi / 2},
                                 {kLength_m, kWidth_m, std::numbers::pi},
                                 {0, kWidth_m, -std::numbers::pi / 2}};
  Timestamp time{};
  for (int leg = 0; leg < 8; ++leg) {
    const Se2& from = corners[leg % 4];
    const double leg_m = leg % 2 == 0 ? kLength_m : kWidth_m;
    for (double at_m = 0.0; at_m < leg_m; at_m += kStep_m) {
      EstimatedPose pose{.time = time += Duration{100'000},
                         .map_from_base = from * Se2{at_m, 0.0, 0.0},
                         .health = Health::kDegenerate};
      pose.covariance.diagonal() << 4e-2, 1e-2, 1e-4;
      const Eigen::Vector2d along = from.rotation() * Eigen::Vector2d::UnitX();
      pose.weak_axis = WeakAxis{.direction = {along.x(), along.y(), 0.0},
                                .information = 1.0,
                                .source = WeakAxisSource::kOdometry};
      scene.estimates.push_back(pose);
    }
  }
  return scene;
}

double share_of_colour(const cv::Mat& image, const cv::Scalar& colour) {
  return static_cast<double>(count_pixels(image, colour)) / static_cast<double>(image.total());
}

TEST(PaintMap, HealthAndUncertaintyMarksHideLessThan60PercentOfFreeSpace) {
  const Scene scene = building_scene();
  const MapPage page = lay_out(content_of(scene), kStyle);
  const double px_per_m = page.strips.front().view.px_per_m;
  EXPECT_LT(strokes_at(px_per_m).health_px, 2.0 * px_per_m) << "the band fits into a corridor";

  const cv::Mat with_marks = paint_map(scene, kStyle);
  Scene bare = scene;
  for (EstimatedPose& pose : bare.estimates) {
    pose.health = Health::kTracking;
    pose.weak_axis.reset();
    pose.covariance.setConstant(std::nan(""));
  }
  const cv::Mat without = paint_map(bare, kStyle);
  const double free_with = share_of_colour(
      with_marks, occupancy_colour()(content_of(scene).map.occupancy_percent(10, 10), -1));
  const double free_without = share_of_colour(
      without, occupancy_colour()(content_of(scene).map.occupancy_percent(10, 10), -1));
  EXPECT_GT(free_with, 0.4 * free_without);
}

TEST(PaintMap, PosesFarFromTheMapDoNotShrinkIt) {
  Scene scene = corridor_scene(10.0);
  const double px_per_m = lay_out(content_of(scene), kStyle).strips.front().view.px_per_m;
  scene.landmarks.push_back({.id = 99, .map_from_marker = {500.0, 0.0, 0.0}});
  EXPECT_EQ(lay_out(content_of(scene), kStyle).strips.front().view.px_per_m, px_per_m);
}

TEST(Labels, LieInsideThePanelOutsideTheCorridorWithoutOverlap) {
  const PageContent content = content_of(corridor_scene(50.0));
  const MapPage page = lay_out(content, kStyle);
  std::size_t count = 0;
  for (const Panel& strip : page.strips) {
    const auto labels = place_labels(content.landmarks, content.map, strip.view, 20.0);
    const cv::Rect2d panel{cv::Point2d{0, 0}, cv::Size2d{strip.page_px.size()}};
    const cv::Point2d lower_left = strip.view({-1.0, -1.0});
    const cv::Point2d upper_right = strip.view({49.0, 1.0});
    const cv::Rect2d corridor{lower_left, upper_right};
    for (std::size_t i = 0; i < labels.size(); ++i) {
      EXPECT_NEAR((labels[i].box_px & panel).area(), labels[i].box_px.area(), 1e-6);
      EXPECT_LT((labels[i].box_px & corridor).area(), 0.02 * labels[i].box_px.area());
      for (std::size_t k = 0; k < i; ++k)
        EXPECT_EQ((labels[i].box_px & labels[k].box_px).area(), 0.0);
    }
    count += labels.size();
  }
  EXPECT_GE(count, content.landmarks.size()) << "each marker has a label in some strip";
}

TEST(Labels, MarkersSideBySideGetLabelsSideBySide) {
  std::vector<Landmark> landmarks;
  for (int i = 0; i < 6; ++i)
    landmarks.push_back({.id = 100 + i, .map_from_marker = {0.1 * i, 1.0, -1.5707963}});
  const GridMap map = room(-3, -1, 3, 1);
  const MapViewport view{.box = {-3.5, -2.0, 3.5, 2.5}, .px_per_m = 100.0};
  const auto labels = place_labels(landmarks, map, view, 16.0);
  for (std::size_t i = 0; i < labels.size(); ++i) {
    for (std::size_t k = 0; k < i; ++k)
      EXPECT_EQ((labels[i].box_px & labels[k].box_px).area(), 0.0) << i << " " << k;
  }
}

TEST(Labels, ShowInstanceAndState) {
  EXPECT_EQ(label_text({.id = 0, .instance = 0}), "0");
  EXPECT_EQ(label_text({.id = 7, .instance = 2}), "7.2");
  EXPECT_EQ(label_text({.id = 7, .state = LandmarkState::kMoved}), "7 moved");
}

TEST(MarkerLayer, FindsConnectedCellsOfAnId) {
  const GridMap map = drawn_map({
      "#000####33##",
      "#..........#",
      "#..........#",
      "##5####33###",
  });
  const auto landmarks = landmarks_of_cells(map);
  ASSERT_THAT(landmarks, SizeIs(2))
      << "a lone 5 is noise; the 3s are too near each other to be two";
  EXPECT_EQ(landmarks[0].id, 0);
  EXPECT_NEAR(landmarks[0].map_from_marker.x(), 2.5 * kCell_m, 1e-9);
  EXPECT_LT(landmarks[0].map_from_marker.theta(), 0.0) << "faces the free cells below";
  EXPECT_EQ(landmarks[1].id, 3);
}

TEST(MarkerLayer, PaintsEachIdInItsColour) {
  GridMap map = room(-1, -1, 9, 1);
  mark_cells(map, {3, 1.02, 0}, 0);
  mark_cells(map, {7, 1.02, 0}, 17);
  const cv::Mat picture = paint_marker_layer(map, "test", kStyle);
  EXPECT_TRUE(contains_colour(picture, colour_of_id(0)));
  EXPECT_TRUE(contains_colour(picture, colour_of_id(17)));
  EXPECT_FALSE(contains_colour(picture, colour_of_id(1)));
  EXPECT_FALSE(paint_marker_layer({}, "empty", kStyle).empty());
}

TEST(Palette, IdsDifferInColour) {
  for (int a = 0; a < 60; ++a) {
    for (int b = 0; b < a; ++b)
      EXPECT_GT(cv::norm(colour_of_id(a) - colour_of_id(b)), 8.0) << a << " " << b;
  }
}

TEST(PaintPlain, HasOnePixelPerCellHighestYFirst) {
  const auto image = paint_plain(drawn_map({"#. ", "..."}), {});
  ASSERT_EQ(image.size(), (cv::Size{3, 2}));
  EXPECT_EQ(image(0, 0), kOccupiedGrey);
  EXPECT_EQ(image(1, 0), kFreeGrey);
  EXPECT_EQ(image(0, 2), kUnknownGrey);
}

TEST(PaintScan, ImageHasTheRequestedSizeAndMarkersTheirColours) {
  const cv::Mat picture = paint_scan(corridor_scan(), 700);
  EXPECT_EQ(picture.size(), (cv::Size{700, 700}));
  EXPECT_TRUE(contains_colour(picture, colour_of_id(4)));
  EXPECT_TRUE(contains_colour(picture, colour_of_id(5)));
  EXPECT_EQ(paint_scan({}, 200).size(), (cv::Size{200, 200}));
}

}  // namespace
}  // namespace waymark::viewer
