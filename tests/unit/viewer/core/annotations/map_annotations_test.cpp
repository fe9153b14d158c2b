// SPDX-License-Identifier: BSD-3-Clause
#include "viewer/core/annotations/map_annotations.hpp"

#include "unit/viewer/drawn_scene.hpp"
#include "unit/viewer/found_on_picture.hpp"
#include "viewer/core/drawing/palette.hpp"
#include "viewer/core/painters/map_painter.hpp"

#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

#include <cmath>
#include <string>
#include <utility>
#include <vector>

namespace waymark::viewer {
namespace {

TEST(Heading, LongTextIsClippedToItsArea) {
  PageContent content = content_of(corridor_scene(50.0));
  for (std::size_t i = 0; i < content.estimates.size(); ++i) {
    content.estimates[i].health = static_cast<Health>(i % 5);
    content.estimates[i].weak_axis =
        WeakAxis{.direction = {1, 0, 0}, .source = static_cast<WeakAxisSource>(i % 4)};
  }
  cv::Mat_<Colour> page(160, 1200, Colour{255, 255, 255});
  const cv::Rect area{60, 0, 1080, 158};
  draw_heading(page, area, "corridor", content, Se2{}, {});
  cv::Mat drawn;
  cv::inRange(page, cv::Scalar{0, 0, 0}, cv::Scalar{250, 250, 250}, drawn);
  const cv::Rect box = cv::boundingRect(drawn);
  EXPECT_GT(box.width, 1000);
  EXPECT_GE(box.x, area.x - 2);
  EXPECT_LE(box.br().x, area.br().x + 2);
}

TEST(Heading, ALongTitleLeavesRoomForTheScaleBar) {
  cv::Mat page(160, 1200, CV_8UC3, palette::kPage);
  draw_heading(page, {60, 0, 1080, 158}, std::string(100, 'M'), {}, Se2{}, {});
  const cv::Mat scale_bar = page.rowRange(20, 70).colRange(720, 1200);
  EXPECT_EQ(count_pixels(scale_bar, palette::kInk), 0);
}

TEST(Ruler, LabelsFarFromTheOriginDiffer) {
  constexpr double kLeft_m = 5'000'000.0;
  const Panel panel{{.box = {kLeft_m, 0, kLeft_m + 20, 1}, .px_per_m = 100.0},
                    cv::Rect{0, 0, 2000, 100}};
  cv::Mat page(200, 2000, CV_8UC3, palette::kPage);
  draw_ruler(page, panel);
  const auto label_at = [&](int x) {
    return page.rowRange(115, 145).colRange(x - 80, x + 80);
  };
  EXPECT_GT(cv::norm(label_at(200), label_at(400)), 0.0);
}

TEST(ScaleBar, IsAsLongAsItsLabelSays) {
  const std::vector<std::pair<double, std::string>> labels{
      {240.0, "1 m"}, {150.0, "2 m"}, {64.0, "5 m"}, {63.0, "5 m"}, {5.0, "50 m"}};
  for (const auto& [px_per_m, label] : labels) {
    cv::Mat page(60, 800, CV_8UC3, palette::kPage);
    draw_scale_bar(page, {700.0, 30.0}, px_per_m);
    EXPECT_TRUE(shows_text(page, label, {.height_px = 17.0, .colour = palette::kInk})) << label;
    int left = 699;
    while (left > 0 && count_pixels(page.col(left), palette::kInk) > 0)
      --left;
    const double length_px = px_per_m * std::stod(label);
    EXPECT_NEAR(699 - left, length_px, 2.0) << label;
    const int second = static_cast<int>(std::lround(700.0 - 0.75 * length_px));
    EXPECT_GE(count_pixels(page.col(second), palette::kInk), 10) << "the frame of the second piece";
    EXPECT_LT(count_pixels(page.col(second + 5), palette::kInk), 6) << "its inside";
  }
}

TEST(Heading, SummarisesMapPathAndHealth) {
  PageContent content{.map = room(-2, -2, 3, 3), .landmarks = {{.id = 1}, {.id = 2}}};
  for (int i = 0; i <= 100; ++i) {  // 10 m in 75 s
    content.estimates.push_back({.time = Timestamp{Duration{750'000 * i}},
                                 .map_from_base = {0.1 * i, 0.0, 0.0},
                                 .health = i == 50 ? Health::kLost : Health::kTracking});
    if (i < 26) content.estimates.back().weak_axis = WeakAxis{.source = WeakAxisSource::kMarkers};
  }
  cv::Mat page(160, 2000, CV_8UC3, palette::kPage);
  draw_heading(page, {60, 0, 1880, 158}, "office", content, Se2{}, {});
  const Font font{.height_px = 18.0, .colour = palette::kFaintInk};
  EXPECT_TRUE(shows_text(page,
                         "free space 5.0 m x 5.0 m   |   2 markers   |   path 10.00 m in "
                         "1 min 15 s",
                         font));
  EXPECT_TRUE(shows_text(page,
                         "health: tracking 99 %, lost 1 %   |   weak axis observed by "
                         "markers 26 % of the updates",
                         font));
}

TEST(Legend, ANarrowPageHasTheWholeLegend) {
  Scene scene = corridor_scene(50.0);
  scene.final_trajectory = {{scene.estimates.front().time, {0, 0, 0}},
                            {scene.estimates.back().time, {48, 0, 0}}};
  for (std::size_t i = 0; i < scene.estimates.size(); ++i) {
    scene.estimates[i].health = static_cast<Health>(i % 5);
    scene.estimates[i].weak_axis =
        WeakAxis{.direction = {1, 0, 0}, .source = static_cast<WeakAxisSource>(i / 600 % 4)};
  }
  scene.changes.emplace();
  for (const auto kind :
       {MapChange::Kind::kMissing, MapChange::Kind::kMoved, MapChange::Kind::kNew,
        MapChange::Kind::kSurveyOff, MapChange::Kind::kWallNew, MapChange::Kind::kWallGone})
    scene.changes->push_back({.kind = kind});
  for (std::size_t i = 0; i < 4; ++i)
    scene.landmarks[i].state = static_cast<LandmarkState>(i);
  const MapPageStyle narrow{.page_width_px = 800};
  const cv::Mat page = paint_map(scene, narrow);
  EXPECT_EQ(page.cols, 800);
  EXPECT_LT(page.rows, lay_out(content_of(scene), narrow).size_px.height) << "there is room left";
  const cv::Mat margin = page.colRange(page.cols - 50, page.cols);
  EXPECT_EQ(count_pixels(margin, palette::kPage), margin.rows * margin.cols)
      << "no text leaves its area";
}

}  // namespace
}  // namespace waymark::viewer
