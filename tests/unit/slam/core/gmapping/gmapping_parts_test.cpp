// SPDX-License-Identifier: BSD-3-Clause
#include "slam/core/gmapping/bell_curve.hpp"
#include "slam/core/gmapping/motion_noise.hpp"
#include "slam/core/gmapping/published_map.hpp"
#include "slam/core/gmapping/scan_gate.hpp"
#include "slam/core/gmapping/trajectory.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

namespace waymark {
namespace {

Trajectory appended(const Trajectory& before, std::shared_ptr<const StoredScan> scan = {}) {
  return std::make_shared<TrajectoryNode>(Se2{}, std::move(scan), before);
}

TEST(StepNoise, HasTheStandardDeviationsOfTheReleasedGmapping) {
  const StepNoise noise{.srr = 0.1, .srt = 0.2, .str = 0.3, .stt = 0.4};
  const Se2 step{0.5, -0.2, 0.1};
  constexpr int kSamples = 40000;
  Eigen::Array3d sum = Eigen::Array3d::Zero();
  Eigen::Array3d sum_of_squares = Eigen::Array3d::Zero();
  for (std::uint64_t i = 0; i < kSamples; ++i) {
    Random random{1, i};
    const Se2 sample = sample_step(step, noise, random);
    const Eigen::Array3d error{sample.x() - step.x(), sample.y() - step.y(),
                               sample.theta() - step.theta()};
    sum += error;
    sum_of_squares += error.square();
  }
  const Eigen::Array3d sigma = (sum_of_squares / kSamples).sqrt();
  const Eigen::Array3d expected{0.1 * 0.5 + 0.03 * 0.2 + 0.3 * 0.1,
                                0.1 * 0.2 + 0.03 * 0.5 + 0.3 * 0.1,
                                0.4 * 0.1 + 0.2 * std::hypot(0.5, 0.2)};
  // Standard error of a standard deviation: sigma / sqrt(2 N); of a mean: sigma / sqrt(N).
  EXPECT_TRUE(((sigma - expected).abs() < 4.0 * expected / std::sqrt(2.0 * kSamples)).all())
      << sigma;
  EXPECT_TRUE((sum.abs() / kSamples < 4.0 * expected / std::sqrt(1.0 * kSamples)).all()) << sum;
}

TEST(StepNoise, NoMotionMeansNoNoise) {
  Random random{1};
  const Se2 sample = sample_step(Se2{}, StepNoise{}, random);
  EXPECT_EQ(sample.x(), 0.0);
  EXPECT_EQ(sample.theta(), 0.0);
}

TEST(ScanGate, OpensByDistanceTurnOrTime) {
  const ScanGate gate{.linear_update_m = 1.0, .angular_update_rad = 0.5, .temporal_update_s = 2.0};
  const Duration second = duration_from_seconds(1.0);
  EXPECT_FALSE(gate.is_open({Se2{}, 0.99, 0.49}, second));
  EXPECT_TRUE(gate.is_open({Se2{}, 1.0, 0.0}, second));
  EXPECT_TRUE(gate.is_open({Se2{}, 0.0, 0.5}, second));
  EXPECT_FALSE(gate.is_open({}, 2 * second));
  EXPECT_TRUE(gate.is_open({}, 2 * second + Duration{1}));
  EXPECT_FALSE((ScanGate{.temporal_update_s = -1.0}.is_open({}, 1000 * second)));
}

TEST(BellCurve, ApproximationErrorIsWithinItsBound) {
  for (const double width : {2.0, 20.0, 30.0}) {
    constexpr double kLimit = 8.0;
    const BellCurve curve{width, kLimit};
    const double promised = (kLimit / width) * (kLimit / width) / 8e6 + 1e-7;  // + float rounding
    for (double squared = 0.0; squared <= kLimit; squared += 0.0013) {
      EXPECT_NEAR(curve(static_cast<float>(squared)), std::exp(-squared / width), promised);
    }
  }
}

TEST(Trajectory, DeadBranchesAreFreed) {
  const Trajectory root = appended(nullptr);
  Trajectory a = appended(appended(root));
  const std::weak_ptr<TrajectoryNode> dead = a;
  const std::weak_ptr<TrajectoryNode> dead_parent = a->parent;
  const Trajectory b = appended(appended(root));
  EXPECT_EQ(common_ancestor({a, b}), root);
  a = b;
  EXPECT_TRUE(dead.expired());
  EXPECT_TRUE(dead_parent.expired());
  EXPECT_EQ(common_ancestor({a, b}), b);
}

TEST(Trajectory, UnrelatedTrajectoriesHaveNoCommonAncestor) {
  EXPECT_EQ(common_ancestor({appended(nullptr), appended(nullptr)}), nullptr);
}

TEST(Trajectory, ALongTrajectoryIsFreedWithoutRecursion) {
  Trajectory trajectory;
  for (int i = 0; i < 1'000'000; ++i)
    trajectory = appended(trajectory);
  const std::weak_ptr<TrajectoryNode> newest = trajectory;
  trajectory.reset();
  EXPECT_TRUE(newest.expired());
}

const GridFrame kFrame = GridFrame::centred_on_map_origin(0.05);

std::shared_ptr<const StoredScan> beam_to(double x_m) {
  return std::make_shared<StoredScan>(
      StoredScan{{0, Eigen::Vector2d::Zero(), Eigen::Vector2d{x_m, 0.0}, x_m}});
}

TEST(DrawScan, CrossesEveryCellUpToTheHit) {
  GridMap map{kFrame, {}, {}};
  draw_scan(*beam_to(0.2), Se2{}, 3.0, map);
  for (int x = 0; x < 4; ++x)
    EXPECT_EQ((map.occupancy[{x, 0}]), (OccupancyCell{0, 1})) << x;
  EXPECT_EQ((map.occupancy[{4, 0}]), (OccupancyCell{1, 1}));
  EXPECT_EQ((map.occupancy[{5, 0}]), (OccupancyCell{}));
}

TEST(DrawScan, ALongBeamClearsOnlyTheUsableRange) {
  GridMap map{kFrame, {}, {}};
  draw_scan(*beam_to(1.0), Se2{}, 0.2, map);
  EXPECT_EQ((map.occupancy[{3, 0}]), (OccupancyCell{0, 1}));
  EXPECT_EQ((map.occupancy[{4, 0}]), (OccupancyCell{}));
  EXPECT_EQ((map.occupancy[{20, 0}]), (OccupancyCell{}));
}

TEST(PublishedMap, ACellIsOccupiedAboveTheThreshold) {
  PublishedMap published{kFrame, 3.0, 0.25};
  Trajectory trajectory = appended(nullptr, beam_to(0.2));
  for (int i = 0; i < 2; ++i)
    trajectory = appended(trajectory, beam_to(0.4));
  EXPECT_EQ((published.along(trajectory).occupancy[{4, 0}]), (OccupancyCell{1, 1}));  // 1 of 3
  trajectory = appended(trajectory, beam_to(0.4));
  EXPECT_EQ((published.along(trajectory).occupancy[{4, 0}]), (OccupancyCell{0, 1}));  // 1 of 4
}

TEST(PublishedMap, FinalisingFreesTheScansAndKeepsTheMap) {
  PublishedMap published{kFrame, 3.0, 0.25};
  Trajectory trajectory = appended(nullptr, beam_to(0.2));
  const std::weak_ptr<const StoredScan> first = trajectory->scan;
  for (int i = 0; i < 5; ++i)
    trajectory = appended(trajectory, beam_to(0.4));
  const GridMap before = published.along(trajectory);
  published.finalise(trajectory->parent);
  EXPECT_TRUE(first.expired());
  const GridMap& after = published.along(trajectory);
  for (int x = -1; x < 12; ++x)
    EXPECT_EQ((after.occupancy[{x, 0}]), (before.occupancy[{x, 0}])) << x;
  EXPECT_EQ(after.occupancy.tile({0, 0}), before.occupancy.tile({0, 0}));  // nothing to send again
}

}  // namespace
}  // namespace waymark
