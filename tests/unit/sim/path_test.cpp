// SPDX-License-Identifier: BSD-3-Clause
#include "sim/core/robot/path.hpp"

#include "common/random/random.hpp"

#include <gtest/gtest.h>

#include <numbers>

namespace waymark {
namespace {

TEST(Path, ACornerBecomesAnArcThatTouchesBothLines) {
  const auto path = path_through({{0.0, 0.0}, {5.0, 0.0}, {5.0, 4.0}}, 1.0);
  ASSERT_EQ(path.size(), 3U);
  EXPECT_NEAR(path[0].length_m, 4.0, 1e-12);
  EXPECT_NEAR(path[1].length_m, 0.5 * std::numbers::pi, 1e-12);
  EXPECT_NEAR(path[1].curvature_per_m, 1.0, 1e-12);
  EXPECT_NEAR(path[2].length_m, 3.0, 1e-12);
  EXPECT_TRUE(path[0].is_smooth_end);
  EXPECT_TRUE(path[1].is_smooth_end);
  EXPECT_FALSE(path[2].is_smooth_end);
  for (std::size_t i = 0; i + 1 < path.size(); ++i) {
    const Se2 gap = path[i].world_from(path[i].length_m).inverse() * path[i + 1].world_from_start;
    EXPECT_NEAR(gap.translation().norm(), 0.0, 1e-12);
    EXPECT_NEAR(gap.theta(), 0.0, 1e-12);
  }
}

TEST(Path, AReversalOfDirectionIsNotRounded) {
  const auto path = path_through({{0.0, 0.0}, {5.0, 0.0}, {0.0, 0.0}}, 1.0);
  ASSERT_EQ(path.size(), 2U);
  EXPECT_FALSE(path[0].is_smooth_end);
}

TEST(Path, ArcsShrinkToTheAvailableSpace) {
  const auto path = path_through({{0.0, 0.0}, {1.0, 0.0}, {1.0, 1.0}, {0.0, 1.0}}, 5.0);
  for (const PathPiece& piece : path)
    EXPECT_GE(piece.length_m, -1e-12);
  EXPECT_NEAR(path.back().world_from(path.back().length_m).x(), 0.0, 1e-12);
}

TEST(Path, LocatingAPoseOnAPieceOfPathInvertsWorldFrom) {
  Random random{1};
  for (int i = 0; i < 200; ++i) {
    const double curvature = i % 3 == 0 ? 0.0 : random.uniform(-1.0, 1.0);
    const PathPiece piece{
        {random.uniform(-5.0, 5.0), random.uniform(-5.0, 5.0), random.uniform(-3.0, 3.0)},
        2.0,
        curvature,
        false};
    const PathPlace place{random.uniform(0.0, 2.0), random.uniform(-0.3, 0.3),
                          random.uniform(-1.0, 1.0)};
    const Se2 world_from_base =
        piece.world_from(place.along_m) * Se2{0.0, place.offset_m, place.heading_error_rad};
    const PathPlace found = locate(piece, world_from_base);
    EXPECT_NEAR(found.along_m, place.along_m, 1e-9);
    EXPECT_NEAR(found.offset_m, place.offset_m, 1e-9);
    EXPECT_NEAR(found.heading_error_rad, place.heading_error_rad, 1e-9);
  }
}

}  // namespace
}  // namespace waymark
