// SPDX-License-Identifier: BSD-3-Clause
#include "viewer/core/layers/change_layer.hpp"

#include "unit/viewer/found_on_picture.hpp"

#include <gtest/gtest.h>

namespace waymark::viewer {
namespace {

using Kind = MapChange::Kind;

/// A picture of 4 m x 2 m whose lower left corner is the map's origin, with 400 x 200 pixels.
cv::Mat_<Colour> drawn(const MapChange& change) {
  const MapViewport view{.box = {0.0, 0.0, 4.0, 2.0}, .px_per_m = 100.0};
  cv::Mat_<Colour> picture(200, 400, to_colour(palette::kPage));
  draw_changes(picture, view, std::vector{change});
  return picture;
}

bool is_marked(const cv::Mat_<Colour>& picture, int x, int y) {
  return picture(y, x) == to_colour(palette::kMoved);
}

void expect_box(const cv::Mat_<Colour>& picture, cv::Rect expected) {
  constexpr int kStroke_px = 4;
  const cv::Rect box = box_of_colour(picture, palette::kMoved);
  EXPECT_NEAR(box.x, expected.x, kStroke_px);
  EXPECT_NEAR(box.y, expected.y, kStroke_px);
  EXPECT_NEAR(box.br().x, expected.br().x, kStroke_px);
  EXPECT_NEAR(box.br().y, expected.br().y, kStroke_px);
}

TEST(ChangeLayer, AMissingMarkerIsACrossOfAMarkersSize) {
  const auto picture = drawn({.kind = Kind::kMissing, .place = {1.0, 1.5, 0.0}});
  expect_box(picture, {80, 30, 40, 40});
  for (const int offset : {-15, 0, 15}) {
    EXPECT_TRUE(is_marked(picture, 100 + offset, 50 + offset)) << offset;
    EXPECT_TRUE(is_marked(picture, 100 + offset, 50 - offset)) << offset;
  }
  EXPECT_FALSE(is_marked(picture, 115, 50));
}

TEST(ChangeLayer, AMovedMarkerIsALineFromARingAtItsOldPlaceToItsPresentOne) {
  for (const Kind kind : {Kind::kMoved, Kind::kSurveyOff}) {
    const auto picture = drawn({.kind = kind, .place = {3.0, 1.0, 0.0}, .was_at = {1.0, 1.0}});
    expect_box(picture, {90, 90, 210, 20});
    EXPECT_TRUE(is_marked(picture, 200, 100));
    EXPECT_TRUE(is_marked(picture, 100, 90)) << "ring";
    EXPECT_TRUE(is_marked(picture, 100, 110)) << "ring";
  }
}

TEST(ChangeLayer, ANewMarkerIsARing) {
  const auto picture = drawn({.kind = Kind::kNew, .place = {1.0, 1.5, 0.0}});
  expect_box(picture, {80, 30, 40, 40});
  EXPECT_FALSE(is_marked(picture, 100, 50));
  EXPECT_FALSE(is_marked(picture, 119, 69)) << "no corner";
}

TEST(ChangeLayer, AWallIsABoxOfItsSizeAndDashedIfItIsGone) {
  const auto present = drawn({.kind = Kind::kWallNew, .place = {2.0, 1.0, 0.0}, .size_m = 1.0});
  const auto gone = drawn({.kind = Kind::kWallGone, .place = {2.0, 1.0, 0.0}, .size_m = 1.0});
  expect_box(present, {150, 50, 100, 100});
  expect_box(gone, {150, 50, 100, 100});
  EXPECT_EQ(spots_of_colour(present, palette::kMoved).size(), 1U);
  EXPECT_GT(spots_of_colour(gone, palette::kMoved).size(), 10U);
}

TEST(ChangeLayer, EvenTheSmallestWallIsVisible) {
  const auto picture = drawn({.kind = Kind::kWallNew, .place = {2.0, 1.0, 0.0}});
  EXPECT_GT(box_of_colour(picture, palette::kMoved).width, 10);
}

TEST(ChangeLayer, NothingIsDrawnForNoChange) {
  EXPECT_TRUE(box_of_colour(drawn({.place = {2.0, 1.0, 0.0}}), palette::kMoved).empty());
}

}  // namespace
}  // namespace waymark::viewer
