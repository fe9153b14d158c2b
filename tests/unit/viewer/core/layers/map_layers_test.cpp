// SPDX-License-Identifier: BSD-3-Clause
#include "viewer/core/layers/map_layers.hpp"

#include "unit/viewer/drawn_scene.hpp"

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

}  // namespace
}  // namespace waymark::viewer
