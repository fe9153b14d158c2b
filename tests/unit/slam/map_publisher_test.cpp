// SPDX-License-Identifier: BSD-3-Clause
// Unit tests of the map as tiles in messages.
#include "slam/map_publisher.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>

namespace waymark {
namespace {

TEST(MapPublisher, RemovedTilesAreSentEmpty) {
  GridMap map{GridFrame::centred_on_map_origin(0.05), {}, {}};
  map.occupancy.edit(map.frame.cell_of(Eigen::Vector2d{0.0, 0.0})) = {1, 1};
  MapPublisher publisher;
  ASSERT_EQ(publisher.all_tiles(map, Timestamp{})[0].num_tiles, 1);
  GridMap elsewhere{map.frame, {}, {}};
  elsewhere.occupancy.edit(map.frame.cell_of(Eigen::Vector2d{20.0, 0.0})) = {1, 1};
  const auto parts = publisher.all_tiles(elsewhere, Timestamp{std::chrono::seconds{1}});
  ASSERT_EQ(parts[0].num_tiles, 2);
  int emptied = 0;
  for (const map_tile_t& tile : parts[0].tiles) {
    emptied += std::all_of(tile.occupancy.begin(), tile.occupancy.end(),
                           [](std::int8_t percent) { return percent == -1; });
  }
  EXPECT_EQ(emptied, 1);
}

}  // namespace
}  // namespace waymark
