// SPDX-License-Identifier: BSD-3-Clause
#include "evaluate/trajectory/trajectory_error.hpp"

#include "common/random/random.hpp"
#include "evaluate/trajectory/nees.hpp"

#include <Eigen/Cholesky>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace waymark::evaluate {
namespace {

constexpr double kExact = 1e-9;

TEST(TrajectoryError, IsSplitAlongTheLineFromFirstToLastTruePose) {
  // The truth drives up the world's y; the map's x is the first heading. Errors at the three poses:
  // none, 0.1 m ahead, 0.3 m to the left and 0.4 m behind.
  const double up = radians(90);
  const std::vector<PosePair> pairs{{0.0, Se2{0, 0, 0}, Se2{5, 1, up}},
                                    {1.0, Se2{2.1, 0, 0}, Se2{5, 3, up}},
                                    {2.0, Se2{3.6, 0.3, radians(3)}, Se2{5, 5, up}}};

  const TrajectoryError error = trajectory_error(pairs, Alignment::kOrigin);

  EXPECT_EQ(error.poses, 3u);
  EXPECT_EQ(error.duration_s, 2.0);
  EXPECT_NEAR(error.ate_origin_m, std::sqrt((0.01 + 0.25) / 3), kExact);
  EXPECT_NEAR(error.along_m->rms, std::sqrt((0.01 + 0.16) / 3), kExact);
  EXPECT_NEAR(error.along_m->max, 0.4, kExact);
  EXPECT_NEAR(error.across_m->rms, 0.3 / std::sqrt(3.0), kExact);
  EXPECT_NEAR(error.across_m->max, 0.3, kExact);
  EXPECT_NEAR(error.distance_m.max, 0.5, kExact);
  EXPECT_NEAR(error.end_distance_m, 0.5, kExact);
  EXPECT_NEAR(error.heading_deg.rms, 3.0 / std::sqrt(3.0), kExact);
  EXPECT_NEAR(error.end_heading_deg, 3.0, kExact);
  // A metre of travel is reached at the next pose: 0.1 m too far, then (-0.5, 0.3).
  EXPECT_EQ(error.rpe_pairs, 2u);
  EXPECT_NEAR(error.rpe_translation_m->rms, std::sqrt((0.01 + 0.34) / 2), kExact);
  EXPECT_NEAR(error.rpe_rotation_deg->max, 3.0, kExact);
}

TEST(TrajectoryError, ARigidlyTransformedCopyHasNoError) {
  Random random{2};
  const Se2 map_from_world{3.0, -7.0, 2.5};
  std::vector<PosePair> pairs;
  for (int i = 0; i < 50; ++i) {
    const Se2 truth{random.uniform(-9, 9), random.uniform(-9, 9), random.uniform(-3, 3)};
    pairs.push_back({0.1 * i, map_from_world * truth, truth});
  }
  for (const Alignment alignment : {Alignment::kOrigin, Alignment::kSe2}) {
    const TrajectoryError error = trajectory_error(pairs, alignment);
    EXPECT_NEAR(error.ate_origin_m, 0.0, kExact);
    EXPECT_NEAR(error.ate_se2_m, 0.0, kExact);
    EXPECT_NEAR(error.heading_deg.max, 0.0, 1e-6);
    EXPECT_NEAR(error.rpe_translation_m->max, 0.0, kExact);
  }
}

TEST(TrajectoryError, NoRigidMotionNearTheBestFitIsBetter) {
  Random random{3};
  std::vector<PosePair> pairs;
  for (int i = 0; i < 40; ++i) {
    const Se2 truth{0.2 * i, random.normal(), 0};
    pairs.push_back(
        {0.1 * i, Se2{truth.x() + random.normal(), truth.y() + random.normal(), 0}, truth});
  }
  const auto cost = [&pairs](const Se2& world_from_map) {
    double sum = 0.0;
    for (const PosePair& pair : pairs)
      sum += (world_from_map * pair.map_from_estimate.translation() -
              pair.world_from_truth.translation())
                 .squaredNorm();
    return std::sqrt(sum / 40.0);
  };
  const Se2 best = align(pairs, Alignment::kSe2);
  EXPECT_NEAR(trajectory_error(pairs, Alignment::kOrigin).ate_se2_m, cost(best), kExact);
  for (int i = 0; i < 200; ++i) {
    const Se2 other{best.x() + random.normal(0, 0.05), best.y() + random.normal(0, 0.05),
                    best.theta() + random.normal(0, 0.02)};
    EXPECT_GE(cost(other), cost(best) - kExact);
  }
}

TEST(TrajectoryError, ADriveWithoutDisplacementHasNoAlongAxis) {
  const std::vector<PosePair> pairs{{0.0, Se2{}, Se2{}}, {1.0, Se2{0.1, 0, 0}, Se2{}}};
  const TrajectoryError error = trajectory_error(pairs, Alignment::kOrigin);
  EXPECT_FALSE(error.along_m);
  EXPECT_FALSE(error.rpe_translation_m);
  EXPECT_EQ(error.rpe_pairs, 0u);
  EXPECT_NEAR(error.ate_origin_m, 0.1 / std::sqrt(2.0), kExact);
}

TEST(Associate, EstimatesOutsideTheTruthAreLeftOut) {
  const Trajectory truth{{1.0, Se2{0, 0, 0}}, {2.0, Se2{1, 0, 0}}};
  const Trajectory estimate{{0.5, Se2{}}, {1.25, Se2{}}, {2.5, Se2{}}};
  const auto pairs = associate(estimate, truth);
  ASSERT_EQ(pairs.size(), 1u);
  EXPECT_NEAR(pairs[0].world_from_truth.x(), 0.25, kExact);
}

TEST(Nees, IsTheSquaredErrorInStandardDeviations) {
  // Map and world differ by a quarter turn; the estimate is 2 sigma off in x, 1 in y, 3 in heading.
  const Se2 world_from_map{4, 4, radians(90)};
  const Se2 map_from_truth{1, 2, 0.1};
  const std::vector<PosePair> pairs{
      {1.0, Se2{1 + 0.2, 2 - 0.02, 0.1 + 0.03}, world_from_map * map_from_truth}};
  const Eigen::Matrix3d covariance = Eigen::Vector3d{0.01, 0.0004, 0.0001}.asDiagonal();

  const Nees result = nees(pairs, {{1.0, covariance}}, world_from_map);

  EXPECT_EQ(result.poses, 1u);
  EXPECT_NEAR(result.mean, 4 + 1 + 9, 1e-6);
  EXPECT_EQ(result.share_in_band, 0.0);
}

TEST(Nees, IsThreeOnAverageForConsistentCovariances) {
  Random random{4};
  Eigen::Matrix3d covariance;
  covariance << 0.04, 0.01, 0.002, 0.01, 0.09, -0.003, 0.002, -0.003, 0.001;
  const Eigen::Matrix3d root = covariance.llt().matrixL();
  std::vector<PosePair> pairs;
  std::vector<StampedCovariance> covariances;
  for (int i = 0; i < 4000; ++i) {
    const Eigen::Vector3d error =
        root * Eigen::Vector3d{random.normal(), random.normal(), random.normal()};
    pairs.push_back({1.0 * i, Se2{error.x(), error.y(), error.z()}, Se2{}});
    covariances.push_back({1.0 * i, covariance});
  }
  const Nees result = nees(pairs, covariances, Se2{});
  EXPECT_EQ(result.poses, 4000u);
  EXPECT_NEAR(result.mean, 3.0, 4 * std::sqrt(6.0 / 4000));  // four standard errors
  EXPECT_NEAR(result.share_in_band, 0.95, 4 * std::sqrt(0.95 * 0.05 / 4000));
}

TEST(Nees, CovariancesThatCannotBeInvertedAreCounted) {
  const std::vector<PosePair> pairs{
      {1.0, Se2{}, Se2{}}, {2.0, Se2{}, Se2{}}, {3.0, Se2{}, Se2{}}, {4.0, Se2{}, Se2{}}};
  const Eigen::Matrix3d indefinite = Eigen::Vector3d{1.0, 1.0, 1.0}.asDiagonal().toDenseMatrix() +
                                     2.0 * (Eigen::Matrix3d::Ones() - Eigen::Matrix3d::Identity());
  const Eigen::Matrix3d tiny = Eigen::Vector3d{1e-200, 1.0, 1.0}.asDiagonal();
  const Nees result =
      nees(pairs, {{1.0, Eigen::Matrix3d::Zero()}, {2.0, indefinite}, {3.0, tiny}}, Se2{});
  EXPECT_EQ(result.poses, 0u);
  EXPECT_EQ(result.singular, 2u);
  EXPECT_EQ(result.invalid, 1u);
  EXPECT_EQ(result.missing, 1u);
  EXPECT_TRUE(std::isnan(result.mean));
}

}  // namespace
}  // namespace waymark::evaluate
