// SPDX-License-Identifier: BSD-3-Clause
#include "slam/core/localisation/map_fit.hpp"

#include "support/round_room.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace waymark {
namespace {

using test::in_a_round_room;
using test::map_of_a_round_room;

TEST(MapFit, ABeamFitsContradictsOrEndsInUnmappedSpace) {
  const GridMap map = map_of_a_round_room(2.0);
  const MapFit same = fit_in_map(map, in_a_round_room(2.0), {});
  EXPECT_TRUE(same.is_decisive());
  EXPECT_EQ(same.fitting, same.beams);
  const MapFit nearer = fit_in_map(map, in_a_round_room(1.5), {});  // where the map is free
  EXPECT_EQ(nearer.contradicting, nearer.beams);
  EXPECT_TRUE(nearer.is_contradicted());
  EXPECT_FALSE(nearer.is_refuted());  // people may stand all round the robot
  const MapFit farther = fit_in_map(map, in_a_round_room(3.0), {});  // through its wall
  EXPECT_GT(farther.contradicting, 0.8 * farther.beams);  // some pass diagonally between cells
  EXPECT_TRUE(farther.is_refuted());
  const MapFit elsewhere = fit_in_map(map, in_a_round_room(2.0), {10.0, 0.0, 0.0});
  EXPECT_FALSE(elsewhere.is_decisive());
  EXPECT_FALSE(elsewhere.is_contradicted());
}

TEST(MapFit, AFewBeamsAreNotDecisive) {
  const std::vector<AnnotatedBeam> all = in_a_round_room(1.5);
  const MapFit fit = fit_in_map(map_of_a_round_room(2.0), std::span{all}.first(10), {});
  EXPECT_EQ(fit.contradicting, 10);
  EXPECT_FALSE(fit.is_contradicted());
}

}  // namespace
}  // namespace waymark
