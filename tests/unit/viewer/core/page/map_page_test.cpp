// SPDX-License-Identifier: BSD-3-Clause
#include "viewer/core/page/map_page.hpp"

#include "unit/viewer/drawn_scene.hpp"

#include <gtest/gtest.h>

namespace waymark::viewer {
namespace {

PageContent content_of_map(const GridMap& map) {
  return {.map = map};
}

TEST(MapPage, ASingleSmallMapStandsInTheMiddle) {
  const MapPage page = lay_out(content_of_map(room(-1, -1, 1, 1)), {});
  ASSERT_EQ(page.strips.size(), 1U);
  const cv::Rect& map_px = page.strips.front().page_px;
  EXPECT_NEAR(map_px.x, page.size_px.width - map_px.br().x, 1);
  EXPECT_GT(map_px.x, 200) << "the legend makes the page wider than the map";
}

TEST(MapPage, ALargeMapFillsThePageBetweenItsMargins) {
  const MapPage page = lay_out(content_of_map(room(-1, -1, 19, 9)), {});
  ASSERT_EQ(page.strips.size(), 1U);
  EXPECT_EQ(page.strips.front().page_px.x, page.heading_px.x);
  EXPECT_EQ(page.strips.front().page_px.br().x, page.heading_px.br().x);
}

TEST(MapPage, StripsOfALongMapStandBelowTheOverviewAndContinueEachOther) {
  const MapPage page = lay_out(content_of_map(room(-1, -1, 59, 1)), {});
  ASSERT_GE(page.strips.size(), 2U);
  ASSERT_TRUE(page.overview);
  const Panel* above = &*page.overview;
  for (const Panel& strip : page.strips) {
    EXPECT_EQ(strip.page_px.x, page.overview->page_px.x);
    EXPECT_GT(strip.page_px.y, above->page_px.br().y);
    if (above != &*page.overview) {
      EXPECT_NEAR(above->view.box.right_m - strip.view.box.left_m, 0.5, 1e-9) << "overlap";
    }
    above = &strip;
  }
  const Box& whole = page.overview->view.box;
  EXPECT_NEAR(page.strips.front().view.box.left_m, whole.left_m, 1e-9);
  EXPECT_NEAR(page.strips.back().view.box.right_m, whole.right_m, 1e-9);
}

}  // namespace
}  // namespace waymark::viewer
