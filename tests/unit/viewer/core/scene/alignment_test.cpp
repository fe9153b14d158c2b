// SPDX-License-Identifier: BSD-3-Clause
#include "viewer/core/scene/alignment.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numbers>

namespace waymark::viewer {
namespace {

constexpr double kQuarterTurn_rad = std::numbers::pi / 2;
constexpr double kRounding = 1e-12;

Timestamp at_s(double seconds) {
  return Timestamp{duration_from_seconds(seconds)};
}

void expect_near(const Se2& actual, const Se2& expected) {
  EXPECT_NEAR(actual.x(), expected.x(), kRounding);
  EXPECT_NEAR(actual.y(), expected.y(), kRounding);
  EXPECT_NEAR(angle_difference(actual.theta(), expected.theta()), 0.0, kRounding);
}

TEST(PoseAt, LiesBetweenTheNeighbours) {
  const std::vector<TimedPose> path{{at_s(1), {0, 0, 0}}, {at_s(3), {4, 2, 1}}};
  expect_near(*pose_at(path, at_s(1.5)), {1, 0.5, 0.25});
  expect_near(*pose_at(path, at_s(1)), {0, 0, 0});
  expect_near(*pose_at(path, at_s(3)), {4, 2, 1});
}

TEST(PoseAt, IsUnknownOutsideThePath) {
  const std::vector<TimedPose> path{{at_s(1), {0, 0, 0}}, {at_s(3), {4, 2, 1}}};
  EXPECT_FALSE(pose_at(path, at_s(0.9)));
  EXPECT_FALSE(pose_at(path, at_s(3.1)));
  EXPECT_FALSE(pose_at({}, at_s(1)));
}

TEST(AlignedOnFirst, AlignsThePathWithTheFirstEstimate) {
  // The robot drives along the world's +y from (5, 1); at 1 s the estimate says (0.5, 0, 0).
  const std::vector<TimedPose> truth{{at_s(0), {5, 1, kQuarterTurn_rad}},
                                     {at_s(2), {5, 3, kQuarterTurn_rad}},
                                     {at_s(4), {5, 5, kQuarterTurn_rad}}};
  const std::vector<EstimatedPose> estimates{{.time = at_s(1), .map_from_base = {0.5, 0, 0}},
                                             {.time = at_s(2), .map_from_base = {7, 7, 7}}};

  const auto aligned = aligned_on_first(estimates, truth);

  ASSERT_EQ(aligned.size(), 3U);
  expect_near(aligned[0].frame_from_base, {-0.5, 0, 0});
  expect_near(aligned[1].frame_from_base, {1.5, 0, 0});
  expect_near(aligned[2].frame_from_base, {3.5, 0, 0});
  EXPECT_EQ(aligned[2].time, at_s(4));
}

TEST(AlignedOnFirst, UsesTheFirstEstimateThatThePathCovers) {
  const std::vector<TimedPose> truth{{at_s(2), {5, 3, 0}}, {at_s(4), {7, 3, 0}}};
  const std::vector<EstimatedPose> estimates{{.time = at_s(1), .map_from_base = {9, 9, 0}},
                                             {.time = at_s(3), .map_from_base = {1, 0, 0}}};

  const auto aligned = aligned_on_first(estimates, truth);

  ASSERT_EQ(aligned.size(), 2U);
  expect_near(aligned[0].frame_from_base, {0, 0, 0});
}

TEST(AlignedOnFirst, IsEmptyWithoutTruthOrEstimates) {
  const std::vector<TimedPose> truth{{at_s(2), {5, 3, 0}}};
  EXPECT_TRUE(aligned_on_first({}, truth).empty());
  EXPECT_TRUE(aligned_on_first(std::vector<EstimatedPose>(1), {}).empty());
}

}  // namespace
}  // namespace waymark::viewer
