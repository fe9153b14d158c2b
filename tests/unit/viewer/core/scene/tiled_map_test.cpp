// SPDX-License-Identifier: BSD-3-Clause
#include "viewer/core/scene/tiled_map.hpp"

#include "unit/viewer/drawn_scene.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace waymark::viewer {
namespace {

using Outcome = TiledMap::Outcome;

constexpr TileLayout kLayout{
    .origin_x_m = 10.0, .origin_y_m = 20.0, .resolution_m = 0.5, .size_cells = 2};

Timestamp at_s(double seconds) {
  return Timestamp{duration_from_seconds(seconds)};
}

/// A tile of 2 x 2 equal cells.
struct Filled {
  std::vector<std::int8_t> occupancy;
  std::vector<std::int16_t> ids;

  Filled(int percent, int id)
      : occupancy(4, static_cast<std::int8_t>(percent)), ids(4, static_cast<std::int16_t>(id)) {}

  TileUpdate at(int tile_x, int tile_y) const { return {tile_x, tile_y, occupancy, ids}; }
};

TEST(TiledMap, IsEmptyWithoutTiles) {
  EXPECT_TRUE(TiledMap{100}.grid().empty());
}

TEST(TiledMap, TilesWithNegativeIndicesLieLeftOfAndBelowTheOrigin) {
  TiledMap map{1000};
  map.put(kLayout, at_s(1), Filled{0, -1}.at(0, 0));
  map.put(kLayout, at_s(1), Filled{100, 7}.at(-2, -1));

  const GridMap grid = map.grid();

  ASSERT_EQ(grid.occupancy_percent.size(), (cv::Size{6, 4}));
  EXPECT_EQ(grid.origin_m, (Eigen::Vector2d{10.0 - 2.0, 20.0 - 1.0}));
  EXPECT_EQ(grid.occupancy_percent(0, 0), 100);
  EXPECT_EQ(grid.marker_ids(1, 1), 7);
  EXPECT_EQ(grid.occupancy_percent(2, 4), 0);
  EXPECT_EQ(grid.occupancy_percent(0, 4), -1) << "no tile there";
  EXPECT_EQ(grid.cell_centre_m(2, 4), (Eigen::Vector2d{10.25, 20.25}));
}

TEST(TiledMap, CellsOfATileAreReadRowByRowFromBelow) {
  TiledMap map{1000};
  const std::vector<std::int8_t> occupancy{1, 2, 3, 4};
  const std::vector<std::int16_t> ids{-1, 0, 5, 6};
  map.put(kLayout, at_s(1), {0, 0, occupancy, ids});

  const GridMap grid = map.grid();

  EXPECT_EQ(grid.occupancy_percent(0, 1), 2);
  EXPECT_EQ(grid.occupancy_percent(1, 0), 3);
  EXPECT_EQ(grid.marker_ids(0, 1), 0) << "0 is an id";
}

TEST(TiledMap, IsCroppedToKnownCells) {
  TiledMap map{1000};
  std::vector<std::int8_t> occupancy{-1, -1, -1, 50};
  map.put(kLayout, at_s(1), {3, 0, occupancy, std::vector<std::int16_t>(4, -1)});

  const GridMap grid = map.grid();

  ASSERT_EQ(grid.occupancy_percent.size(), (cv::Size{1, 1}));
  EXPECT_EQ(grid.origin_m, (Eigen::Vector2d{10.0 + 3.5, 20.5}));
}

TEST(TiledMap, TheNewestContentWinsWhateverTheOrderOfArrival) {
  TiledMap map{1000};
  EXPECT_EQ(map.put(kLayout, at_s(2), Filled{80, -1}.at(0, 0)), Outcome::kStored);
  EXPECT_EQ(map.put(kLayout, at_s(1), Filled{10, -1}.at(0, 0)), Outcome::kOlderThanKnown);
  EXPECT_EQ(map.put(kLayout, at_s(2), Filled{80, -1}.at(0, 0)), Outcome::kStored) << "a repeat";

  EXPECT_EQ(map.grid().occupancy_percent(0, 0), 80);
}

TEST(TiledMap, ATileWithAMuchOlderStampCountsAsNewerAfterAClockStep) {
  TiledMap map{1000};
  map.put(kLayout, at_s(100), Filled{80, -1}.at(0, 0));
  EXPECT_EQ(map.put(kLayout, at_s(10), Filled{10, -1}.at(0, 0)), Outcome::kStored);
  EXPECT_EQ(map.grid().occupancy_percent(0, 0), 10);
}

TEST(TiledMap, AStrayTileCannotAllocateUnboundedMemory) {
  TiledMap map{1000};
  map.put(kLayout, at_s(1), Filled{0, -1}.at(0, 0));

  EXPECT_EQ(map.put(kLayout, at_s(1), Filled{0, -1}.at(1 << 30, -(1 << 30))), Outcome::kTooFarAway);

  EXPECT_EQ(map.grid().occupancy_percent.size(), (cv::Size{2, 2}));
}

TEST(TiledMap, MalformedTilesAreRefused) {
  TiledMap map{1000};
  const Filled tile{0, -1};
  TileLayout layout = kLayout;
  layout.size_cells = 3;
  EXPECT_EQ(map.put(layout, at_s(1), tile.at(0, 0)), Outcome::kMalformed);
  layout = kLayout;
  layout.resolution_m = 0.0;
  EXPECT_EQ(map.put(layout, at_s(1), tile.at(0, 0)), Outcome::kMalformed);
  EXPECT_TRUE(map.grid().empty());
}

TEST(TiledMap, AnotherLayoutStartsAnotherMap) {
  TiledMap map{1000};
  map.put(kLayout, at_s(5), Filled{0, -1}.at(0, 0));
  TileLayout layout = kLayout;
  layout.resolution_m = 0.25;

  EXPECT_EQ(map.put(layout, at_s(1), Filled{100, -1}.at(9, 9)), Outcome::kStored);

  EXPECT_EQ(map.grid().occupancy_percent.size(), (cv::Size{2, 2}));
}

}  // namespace
}  // namespace waymark::viewer
