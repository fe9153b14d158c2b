// SPDX-License-Identifier: BSD-3-Clause
#include "common/random/random.hpp"
#include "slam/core/grid/grid_map.hpp"
#include "slam/core/grid/line.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <vector>

namespace waymark {
namespace {

using ::testing::ElementsAre;

TEST(CellIndex, NegativeCellsHaveDistinctTilesAndOffsets) {
  EXPECT_EQ(tile_of({-1, 0}), (TileIndex{-1, 0}));
  EXPECT_EQ(tile_of({-32, 31}), (TileIndex{-1, 0}));
  EXPECT_EQ(tile_of({-33, 32}), (TileIndex{-2, 1}));
  for (const CellIndex cell : {CellIndex{-1, -1}, {0, 0}, {31, -32}, {-33, 64}, {1000, -999}}) {
    EXPECT_EQ(cell_at(tile_of(cell), offset_in_tile(cell)), cell);
  }
}

TEST(TileMap, ReadsDefaultsWhereNothingWasWritten) {
  TileMap<int> map;
  EXPECT_EQ((map[{12345, -6789}]), 0);
  map.edit({5, 5}) = 7;
  EXPECT_EQ((map[{5, 5}]), 7);
  EXPECT_EQ((map[{5, 6}]), 0);
  EXPECT_EQ(map.num_tiles(), 1U);
}

TEST(TileMap, AWrittenTileIsNoLongerSharedByTheCopyAndTheOthersAre) {
  TileMap<int> original;
  original.edit({0, 0}) = 1;
  original.edit({100, 0}) = 2;

  TileMap<int> copy = original;
  EXPECT_EQ(copy.tile({0, 0}), original.tile({0, 0}));
  EXPECT_EQ(copy.tile({3, 0}), original.tile({3, 0}));

  copy.edit({1, 1}) = 3;
  EXPECT_NE(copy.tile({0, 0}), original.tile({0, 0}));
  EXPECT_EQ((copy[{0, 0}]), 1);
  EXPECT_EQ((original[{1, 1}]), 0);
  EXPECT_EQ(copy.tile({3, 0}), original.tile({3, 0}));
}

TEST(TileMap, TilesAreVisitedRowByRow) {
  TileMap<int> map;
  for (const CellIndex cell : {CellIndex{40, 40}, {-40, 40}, {0, -40}, {0, 0}}) {
    map.edit(cell) = 1;
  }
  std::vector<TileIndex> visited;
  map.for_each_tile([&](TileIndex index, const auto&) { visited.push_back(index); });
  EXPECT_THAT(visited,
              ElementsAre(TileIndex{0, -2}, TileIndex{0, 0}, TileIndex{-2, 1}, TileIndex{1, 1}));
}

TEST(TileMap, RefusesToGrowBeyondItsLimit) {
  TileMap<int> map;
  map.edit({0, 0}) = 1;
  EXPECT_THROW(map.edit({1 << 28, 1 << 28}), std::length_error);
  EXPECT_EQ((map[{0, 0}]), 1);
}

// Whatever the order of copies, overwritten copies and edits, tiles behave like plain copies.
TEST(TileMap, EqualsPlainCopiesOverRandomGenealogies) {
  constexpr int kMaps = 6;
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    Random random{seed};
    std::vector<TileMap<int>> tiled(kMaps);
    std::vector<std::map<CellIndex, int>> plain(kMaps);
    for (int step = 0; step < 400; ++step) {
      const auto a = random() % kMaps;
      const auto b = random() % kMaps;
      if (random.uniform() < 0.1) {
        tiled[a] = tiled[b];
        plain[a] = plain[b];
      } else {
        const CellIndex cell{static_cast<int>(random.uniform(-150.0, 150.0)),
                             static_cast<int>(random.uniform(-70.0, 70.0))};
        tiled[a].edit(cell) += step;
        plain[a][cell] += step;
      }
    }
    for (int i = 0; i < kMaps; ++i) {
      for (int y = -80; y < 80; ++y) {
        for (int x = -160; x < 160; ++x) {
          const auto found = plain[i].find({x, y});
          ASSERT_EQ((tiled[i][{x, y}]), found == plain[i].end() ? 0 : found->second);
        }
      }
    }
  }
}

TEST(GridFrame, TheMapOriginIsTheCentreOfACell) {
  const GridFrame frame = GridFrame::centred_on_map_origin(0.05);
  EXPECT_EQ(frame.cell_of({0.0, 0.0}), (CellIndex{0, 0}));
  EXPECT_EQ(frame.cell_of({0.024, -0.024}), (CellIndex{0, 0}));
  EXPECT_EQ(frame.cell_of({0.026, -0.026}), (CellIndex{1, -1}));
  EXPECT_TRUE(frame.centre_of({20, -20}).isApprox(Eigen::Vector2d{1.0, -1.0}, 1e-12));
}

TEST(VisitLine, TouchesBothEndsAndEveryCellBetween) {
  std::vector<CellIndex> cells;
  visit_line({0, 0}, {-3, 1}, [&](CellIndex cell) { cells.push_back(cell); });
  EXPECT_THAT(cells,
              ElementsAre(CellIndex{0, 0}, CellIndex{-1, 0}, CellIndex{-2, 1}, CellIndex{-3, 1}));
  cells.clear();
  visit_line({2, 2}, {2, 2}, [&](CellIndex cell) { cells.push_back(cell); });
  EXPECT_THAT(cells, ElementsAre(CellIndex{2, 2}));
}

TEST(MarkerCell, IdZeroIsAMarkerAndAVoteForNoMarkerIsNot) {
  MarkerCell cell;
  EXPECT_EQ(cell.most_supported(), kNoMarker);
  cell.vote(kNoMarker, 2.0F);
  EXPECT_EQ(cell.most_supported(), kNoMarker);
  cell.vote(0, 3.0F);
  EXPECT_EQ(cell.most_supported(), 0);
  EXPECT_EQ(cell.votes_for(0), 3.0F);
  EXPECT_EQ(cell.votes(), 5.0F);
}

TEST(MarkerCell, AWrongIdDoesNotOverwriteACorrectOne) {
  MarkerCell cell;
  for (int i = 0; i < 10; ++i)
    cell.vote(7, 1.0F);
  for (int wrong = 20; wrong < 26; ++wrong)
    cell.vote(wrong, 1.0F);
  EXPECT_EQ(cell.most_supported(), 7);
}

TEST(MarkerCell, AFrequentIdReplacesManyStrayOnes) {
  MarkerCell cell;
  for (int stray = 0; stray < 9; ++stray)
    cell.vote(stray, 1.0F);
  for (int i = 0; i < 8; ++i)
    cell.vote(42, 1.0F);
  EXPECT_EQ(cell.most_supported(), 42);
}

}  // namespace
}  // namespace waymark
