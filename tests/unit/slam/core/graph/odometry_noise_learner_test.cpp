// SPDX-License-Identifier: BSD-3-Clause
// Noise of the odometry, learnt from innovations.
#include "slam/core/graph/odometry_noise_learner.hpp"

#include "common/geometry/squared.hpp"
#include "common/random/random.hpp"

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
  EXPECT_NEAR(described.scale().turn, 1.0, 1e-3);
  EXPECT_NEAR(worse.scale().turn, 8.0, 3.0);
  EXPECT_GT(worse.scale().along, 1.5);  // wheels that are bad in the turn are so along the way
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
    EXPECT_LT(spins.scale().turn, 2.0) << i;
  }
  EXPECT_NEAR(worse.scale().turn, 8.0, 3.0);
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
  EXPECT_GT(learner.scale().slip_m2_per_m, 0.7 * 0.01);
  EXPECT_LT(learner.scale().slip_m2_per_m, 2.0 * 0.7 * 0.01);
  EXPECT_LT(learner.scale().slip_per_m, -0.7 * 0.05);
}

TEST(OdometryNoiseLearner, WithoutSlipsTheirVarianceIsSmall) {
  EXPECT_LT(learner_after(0.0).scale().slip_m2_per_m, 2e-5);
}

}  // namespace
}  // namespace waymark
