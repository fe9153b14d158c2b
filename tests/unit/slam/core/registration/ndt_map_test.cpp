// SPDX-License-Identifier: BSD-3-Clause
// Grids of normal distributions, whole and divided.
#include "slam/core/registration/ndt_map.hpp"

#include "common/random/random.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace waymark {
namespace {

/// The point variance changes during a run, because the noise of ranges is learnt.
TEST(NdtMap, ACellIsRecomputedForANewPointVariance) {
  const auto wall = [] {
    NdtMap map{0.25};
    for (int i = 0; i < 8; ++i)
      map.add({0.02 * i, i % 2 == 0 ? 0.001 : -0.001}, 0);
    return map;
  };
  const NdtMap asked_before = wall();
  ASSERT_NE(asked_before.at({0.0, 0.0}, 1e-2), nullptr);
  const NdtMap fresh = wall();
  EXPECT_EQ(asked_before.at({0.0, 0.0}, 1e-4)->across_m2, fresh.at({0.0, 0.0}, 1e-4)->across_m2);
  EXPECT_EQ(asked_before.at({0.0, 0.0}, 1e-4)->is_line, fresh.at({0.0, 0.0}, 1e-4)->is_line);
}

/// A wall along x whose right half stands back by 0.1 m, like a door in its frame, seen with noise.
NdtMap recess(NdtMap::Cells cells) {
  NdtMap map{0.25, cells};
  Random random{{7}};
  const auto add = [&](double x, double y) {
    map.add({x + 0.002 * random.normal(), y + 0.002 * random.normal()}, 0);
  };
  for (double x = 0.0; x <= 1.0; x += 0.02)
    for (int i = 0; i < 3; ++i)
      add(x, x < 0.5 ? 1.0 : 1.1);
  for (double y = 1.0; y <= 1.1; y += 0.01)
    add(0.5, y);
  return map;
}

constexpr double kRecessVariance_m2 = 4e-6;

TEST(NdtMap, APartOfAThickCellShowsAJambThatTheCellHides) {
  const Eigen::Vector2d on_jamb{0.5, 1.05};
  const NdtMap whole = recess(NdtMap::Cells::kWhole);
  const NdtMap divided = recess(NdtMap::Cells::kDivided);
  EXPECT_LT(std::abs(whole.at(on_jamb, kRecessVariance_m2)->normal.x()), 0.5);
  EXPECT_GT(std::abs(divided.at(on_jamb, kRecessVariance_m2)->normal.x()), 0.7);
}

TEST(NdtMap, ThinCellsAreNotDivided) {
  const NdtMap whole = recess(NdtMap::Cells::kWhole);
  const NdtMap divided = recess(NdtMap::Cells::kDivided);
  const Eigen::Vector2d on_wall{0.1, 1.0};
  EXPECT_EQ(divided.at(on_wall, kRecessVariance_m2)->count,
            whole.at(on_wall, kRecessVariance_m2)->count);
  EXPECT_EQ(divided.at({0.1, 3.0}, kRecessVariance_m2), nullptr);
}

TEST(NdtMap, EveryPointOfAPartIsInTheCellOfThatPart) {
  const NdtMap map{0.25, NdtMap::Cells::kDivided};
  Random random{{3}};
  for (int i = 0; i < 1000; ++i) {
    const Eigen::Vector2d point{3.0 * random.normal(), 3.0 * random.normal()};
    EXPECT_EQ(NdtMap::cell_of_part(map.part_at(point)), map.key_at(point));
  }
}

TEST(NdtMap, DroppingUnusedPartsChangesNoDistribution) {
  const NdtMap all = recess(NdtMap::Cells::kDivided);
  NdtMap dropped = all;
  dropped.drop_unused_parts(kRecessVariance_m2);
  for (double x = -0.3; x < 1.3; x += 0.03) {
    for (double y = 0.7; y < 1.4; y += 0.03) {
      const NdtCell* before = all.at({x, y}, kRecessVariance_m2);
      const NdtCell* after = dropped.at({x, y}, kRecessVariance_m2);
      ASSERT_EQ(before == nullptr, after == nullptr);
      if (before == nullptr) continue;
      EXPECT_EQ(before->mean, after->mean);
    }
  }
}

}  // namespace
}  // namespace waymark
