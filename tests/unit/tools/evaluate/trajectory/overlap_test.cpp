// SPDX-License-Identifier: BSD-3-Clause
// How much of a trajectory another one covers.
#include "evaluate/trajectory/overlap.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace waymark::evaluate {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

constexpr double kTolerance = 1e-9;

struct Poses {
  double from_s{};
  double to_s{};
  double every_s{};
};

/// A drive along x at 0.5 m/s, at rest between 40 and 60 s.
Trajectory drive_with_a_rest(const Poses& poses) {
  Trajectory trajectory;
  const int count = static_cast<int>(std::lround((poses.to_s - poses.from_s) / poses.every_s));
  for (int i = 0; i <= count; ++i) {
    const double t_s = poses.from_s + poses.every_s * i;
    const double driving_s = t_s < 40.0 ? t_s : std::max(40.0, t_s - 20.0);
    trajectory.push_back({t_s, Se2{0.5 * driving_s, 0.0, 0.0}});
  }
  return trajectory;
}

Overlap overlap_with_100_s(const Trajectory& estimate) {
  const Trajectory truth = drive_with_a_rest({0.0, 100.0, 0.1});
  return overlap_of(estimate, truth, associate(estimate, truth));
}

Trajectory without(Trajectory trajectory, double from_s, double to_s) {
  std::erase_if(trajectory, [&](const StampedPose& pose) {
    return pose.t_s > from_s + kTolerance && pose.t_s < to_s - kTolerance;
  });
  return trajectory;
}

TEST(Overlap, EndsWithTheLastPose) {
  const Overlap whole = overlap_with_100_s(drive_with_a_rest({0.0, 100.0, 0.2}));
  EXPECT_NEAR(whole.covered_share, 1.0, kTolerance);
  EXPECT_THAT(problems_of(whole, "truth"), IsEmpty());
  const Overlap part = overlap_with_100_s(drive_with_a_rest({0.0, 70.0, 0.2}));
  EXPECT_NEAR(part.covered_share, 0.7, kTolerance);
  EXPECT_THAT(problems_of(part, "reference"),
              ElementsAre("covers 70.0 % of the reference's time from the first pose on, expected "
                          "at least 95 %"));
}

TEST(Overlap, CountsFromTheFirstPoseOnAndSaysWhenThatIsLate) {
  const Overlap late = overlap_with_100_s(drive_with_a_rest({30.0, 100.0, 0.2}));
  EXPECT_NEAR(late.covered_share, 1.0, kTolerance);
  EXPECT_NEAR(late.first_pose_s, 30.0, kTolerance);
  EXPECT_THAT(problems_of(late, "truth"), IsEmpty());
  EXPECT_THAT(late_start_of(late, "truth").value_or(""), HasSubstr("begins 30.0 s after"));
  EXPECT_FALSE(late_start_of(overlap_with_100_s(drive_with_a_rest({4.0, 100.0, 0.2})), "truth"));
}

TEST(Overlap, AGapInTheEstimateCountsAsCoveredIfTheRobotHardlyMoves) {
  const Trajectory estimate = drive_with_a_rest({0.0, 100.0, 0.2});
  EXPECT_NEAR(overlap_with_100_s(without(estimate, 40.0, 60.0)).covered_share, 1.0, kTolerance);
  EXPECT_NEAR(overlap_with_100_s(without(estimate, 10.0, 30.0)).covered_share, 0.8, kTolerance);
}

TEST(Overlap, EstimatesPublishedOnlyAtUpdatesCoverTheWholeRun) {
  constexpr double kUpdate_s = 2.0;  // a metre
  const Trajectory updates = drive_with_a_rest({0.0, 100.0, kUpdate_s});
  EXPECT_NEAR(overlap_with_100_s(updates).covered_share, 1.0, kTolerance);
}

TEST(Overlap, TheDistanceDrivenInAGapCountsNotTheStraightLine) {
  Trajectory circle;
  for (int i = 0; i <= 100; ++i)
    circle.push_back({1.0 * i, Se2{std::cos(0.1 * i), std::sin(0.1 * i), 0.0}});
  const Trajectory estimate = without(circle, 10.0, 73.0);  // one turn
  const Overlap overlap = overlap_of(estimate, circle, associate(estimate, circle));
  EXPECT_NEAR(overlap.covered_share, 0.37, kTolerance);
}

TEST(Overlap, PosesOutsideAreCounted) {
  const Overlap overlap = overlap_with_100_s(drive_with_a_rest({0.0, 200.0, 1.0}));
  EXPECT_EQ(overlap.outside, 100u);
  EXPECT_THAT(problems_of(overlap, "truth"),
              ElementsAre("100 of 201 poses are outside the truth's time span"));
}

}  // namespace
}  // namespace waymark::evaluate
