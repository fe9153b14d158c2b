// SPDX-License-Identifier: BSD-3-Clause
// Noise of the odometry, learnt from innovations.
#include "slam/core/odometry/odometry_noise_learner.hpp"

#include "common/geometry/squared.hpp"
#include "common/random/random.hpp"
#include "slam/core/graph/factors.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace waymark {
namespace {

TEST(OdometryNoiseLearner, KeepsTheConfiguredNoiseUntilInnovationsContradictIt) {
  OdometryNoiseLearner described;
  OdometryNoiseLearner worse;
  Random random{{7}};
  for (int i = 0; i < 200; ++i) {
    const double normal = random.normal();
    described.observe_turn({1e-3 * normal, 1e-6, 1e-8});
    worse.observe_turn({8e-3 * normal, 1e-6, 1e-8});
  }
  EXPECT_NEAR(described.learnt_noise().turn, 1.0, 1e-3);
  EXPECT_NEAR(worse.learnt_noise().turn, 8.0, 3.0);
  EXPECT_GT(worse.learnt_noise().along,
            1.5);  // wheels that are bad in the turn are so along the way
}

TEST(OdometryNoiseLearner, AWheelThatSpinsForMetresDoesNotRaiseTheNoise) {
  OdometryNoiseLearner spins;
  OdometryNoiseLearner worse;
  Random random{{9}};
  for (int i = 0; i < 200; ++i) {
    const double distance_m = 0.04 + 0.04 * random.uniform();
    const double sigma_rad = 0.0087 * std::sqrt(distance_m);
    const double noise_rad = sigma_rad * random.normal();
    const double spin_rad = i >= 100 && i < 160 ? 0.35 * distance_m : 0.0;
    spins.observe_turn({noise_rad + spin_rad, squared(sigma_rad), 1e-7, distance_m});
    worse.observe_turn({8.0 * noise_rad, squared(sigma_rad), 1e-7, distance_m});
    EXPECT_LT(spins.learnt_noise().turn, 2.0) << i;
  }
  EXPECT_NEAR(worse.learnt_noise().turn, 8.0, 3.0);
}

/// 40 m in steps of 5 cm, each seen to 5 mm; `slips_per_m` of 10 cm.
OdometryNoiseLearner learner_after(double slips_per_m) {
  OdometryNoiseLearner learner;
  Random random{{8}};
  for (int i = 0; i < 800; ++i) {
    const double slip_m = random.uniform() < 0.05 * slips_per_m ? 0.1 : 0.0;
    const OdometryInnovation innovation{0.005 * random.normal() - slip_m, 0.05 * 0.003 * 0.003,
                                        2.5e-5, 0.05};
    learner.observe_slip(innovation);
    learner.observe_along(innovation);
  }
  return learner;
}

TEST(OdometryNoiseLearner, SlipsAddTheirSecondMomentPerMetre) {
  const OdometryNoiseLearner learner = learner_after(0.7);
  EXPECT_NEAR(learner.num_slips(), 28, 12);
  EXPECT_GT(learner.learnt_noise().slip_m2_per_m, 0.7 * 0.01);
  EXPECT_LT(learner.learnt_noise().slip_m2_per_m, 2.0 * 0.7 * 0.01);
  EXPECT_LT(learner.learnt_noise().slip_per_m, -0.7 * 0.05);
  EXPECT_NEAR(learner.learnt_noise().slip_m2, 0.01, 0.002);
}

TEST(OdometryNoiseLearner, WithoutSlipsTheLearntSlipVarianceIsSmall) {
  EXPECT_LT(learner_after(0.0).learnt_noise().slip_m2_per_m, 2e-5);
}

/// Variance along the path of a factor over 1 m, if all else observes it to `sigma_m`.
double variance_along(double sigma_m) {
  LearntOdometryNoise scale = learner_after(0.7).learnt_noise();
  scale.along = 1.0;
  OdometryFactor factor{0, 1, Motion::between({}, {1.0, 0.0, 0.0})};
  const Eigen::Matrix2d place = squared(sigma_m) * Eigen::Matrix2d::Identity();
  factor.hidden_slips = hidden_share(factor.motion, {{place}}, scale);
  State state;
  state.keyframes = {{}, {1.0, 0.0, 0.0}};
  const LinearFactor linear = factor.linearise(state, {}, scale);
  const Eigen::Matrix3d& root = linear.blocks[1].jacobian;
  return (root.transpose() * root).inverse()(0, 0);
}

TEST(OdometryNoiseLearner, SlipsAddVarianceAsFarAsMarkersDoNotObserveThem) {
  const double rolling_m2 = variance_along(1e-4);
  const double hidden_m2 = variance_along(100.0) - rolling_m2;
  EXPECT_NEAR(rolling_m2, 9e-6, 4e-6);
  EXPECT_GT(hidden_m2, 0.7 * 0.01);
  EXPECT_NEAR(variance_along(0.1) - rolling_m2, 0.5 * hidden_m2,
              0.05 * hidden_m2);  // slips of 0.1 m
}

}  // namespace
}  // namespace waymark
