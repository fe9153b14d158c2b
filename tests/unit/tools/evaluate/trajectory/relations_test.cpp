// SPDX-License-Identifier: BSD-3-Clause
#include "evaluate/trajectory/relations.hpp"

#include "unit/tools/temporary_folder.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace waymark::evaluate {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

constexpr double kExact = 1e-9;

TEST(Relations, ErrorsAreThoseComputedByHand) {
  // One metre per second along x, then a quarter turn on the spot from t=2 to t=4.
  const Trajectory trajectory{{0, Se2{0, 0, 0}}, {2, Se2{2, 0, 0}}, {4, Se2{2, 0, radians(90)}}};
  // - 0.5 -> 1.5 s: 1 m ahead; relation: 0.9 m ahead, 0.1 m left, 2 deg; error 0.1 sqrt 2 m, 2 deg.
  // - 1 -> 3 s: 1 m ahead, 45 deg; the relation is the same: no error.
  // - 4 -> 1 s, seen after the turn: (0, 1), -90 deg; relation: (0.3, 1), -80 deg; error 0.3 m, 10
  //   deg.
  const std::vector<Relation> relations{{1, 0.5, 1.5, Se2{0.9, 0.1, radians(2)}},
                                        {2, 1.0, 3.0, Se2{1.0, 0.0, radians(45)}},
                                        {3, 4.0, 1.0, Se2{0.3, 1.0, radians(-80)}}};
  SkippedLines skipped;

  const RelationsError error = relations_error(trajectory, relations, "r", skipped);

  EXPECT_EQ(error.all.count, 3u);
  const double first = 0.1 * std::sqrt(2.0);
  const double mean = (first + 0.0 + 0.3) / 3;
  EXPECT_NEAR(error.all.translation_m.mean, mean, kExact);
  EXPECT_NEAR(error.all.translation_m.sigma, std::sqrt((0.02 + 0.0 + 0.09) / 3 - mean * mean),
              kExact);
  EXPECT_NEAR(error.all.rotation_deg.mean, 4.0, kExact);
  EXPECT_NEAR(error.all.rotation_deg.sigma, std::sqrt((4.0 + 0.0 + 100.0) / 3 - 16.0), kExact);
  EXPECT_THAT(skipped, IsEmpty());
}

TEST(Relations, TimesOutsideTheTrajectoryAreNamed) {
  const Trajectory trajectory{{10, Se2{}}, {11, Se2{}}};
  SkippedLines skipped;
  const RelationsError error = relations_error(
      trajectory, {{4, 9.5, 10.5, Se2{}}, {5, 10.0, 11.0, Se2{}}, {6, 10.5, 11.5, Se2{}}}, "r",
      skipped);
  EXPECT_EQ(error.all.count, 1u);
  EXPECT_THAT(skipped,
              ElementsAre(HasSubstr("r:4: time 9.500000 is outside the trajectory (10.000000 to"),
                          HasSubstr("r:6: time 11.500000 is outside")));
}

TEST(Relations, NearAndFarAreDistinguishedByTheTimeBetween) {
  const Trajectory trajectory{{0, Se2{}}, {100, Se2{}}};
  SkippedLines skipped;
  const RelationsError error = relations_error(trajectory,
                                               {{1, 0.0, 4.9, Se2{1, 0, 0}},
                                                {2, 4.0, 0.0, Se2{3, 0, 0}},  // backwards in time
                                                {3, 0.0, 5.0, Se2{7, 0, 0}},  // neither
                                                {4, 0.0, 60.0, Se2{9, 0, 0}},
                                                {5, 99.0, 30.0, Se2{5, 0, radians(6)}}},
                                               "r", skipped);
  EXPECT_EQ(error.all.count, 5u);
  EXPECT_EQ(error.near.count, 2u);
  EXPECT_NEAR(error.near.translation_m.mean, 2.0, kExact);
  EXPECT_EQ(error.far.count, 1u);
  EXPECT_NEAR(error.far.translation_m.mean, 5.0, kExact);
  EXPECT_NEAR(error.far.rotation_deg.mean, 6.0, kExact);
}

TEST(Relations, BadLinesAreNamed) {
  const TemporaryFolder folder;
  SkippedLines skipped;
  const auto relations =
      read_relations(folder.file("r",
                                 "# t1 t2 x y z roll pitch yaw\n1 2 3 4 0 0 0 0.5\n1 2 3 4 0 0 0\n"
                                 "1 2 3 4 0.1 0 0 0.5\n1 2 inf 4 0 0 0 0.5\n"),
                     skipped);
  ASSERT_EQ(relations.size(), 1u);
  EXPECT_EQ(relations[0].line, 2u);
  EXPECT_EQ(relations[0].base1_from_base2.y(), 4.0);
  EXPECT_EQ(relations[0].base1_from_base2.theta(), 0.5);
  EXPECT_THAT(skipped, ElementsAre(HasSubstr("r:3: got"), HasSubstr("r:4: z, roll and pitch"),
                                   HasSubstr("r:5: got")));
  EXPECT_THROW(read_relations(folder.file("empty", ""), skipped), SetupError);
}

TEST(Relations, TheFreiburgFileIsReadWhole) {
  const std::filesystem::path file = "/work/shared/data/logs/fr079.relations";
  if (!std::filesystem::exists(file)) GTEST_SKIP() << file << " is not here";
  SkippedLines skipped;
  EXPECT_EQ(read_relations(file, skipped).size(), 1685u);
  EXPECT_THAT(skipped, IsEmpty());
}

}  // namespace
}  // namespace waymark::evaluate
