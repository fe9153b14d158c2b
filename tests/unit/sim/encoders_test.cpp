// SPDX-License-Identifier: BSD-3-Clause
#include "sim/core/sensors/encoders.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace waymark {
namespace {

OdometryErrorConfig no_errors() {
  OdometryErrorConfig errors{};
  errors.draw_from_seed = false;
  errors.diffusion_m_per_sqrt_m = 0.0;
  errors.heading_diffusion_deg_per_sqrt_m = 0.0;
  errors.ticks_per_turn = 0;
  return errors;
}

/// Odometry after driving by these wheel distances, measured in `steps` steps.
Se2 after(const OdometryErrorConfig& errors, double left_m, double right_m, int steps,
          std::int64_t seed = 1) {
  const BaseConfig base{};
  WheelOdometry odometry{base, errors, seed};
  OdometrySample sample = odometry.measure({}, {});
  for (int i = 1; i <= steps; ++i) {
    const double share = static_cast<double>(i) / steps;
    sample = odometry.measure(
        {}, {share * left_m / base.wheel_radius_m, share * right_m / base.wheel_radius_m});
  }
  return sample.odom_from_base;
}

struct Spread {
  double sigma_x_m;
  double sigma_theta_rad;
};

/// Standard deviations over many seeds after `distance_m` straight ahead.
Spread spread(const OdometryErrorConfig& errors, double distance_m, int steps) {
  constexpr int kRuns = 600;
  double sum_x2 = 0.0, sum_theta2 = 0.0;
  for (int seed = 0; seed < kRuns; ++seed) {
    const Se2 end = after(errors, distance_m, distance_m, steps, seed);
    sum_x2 += std::pow(end.x() - distance_m, 2);
    sum_theta2 += std::pow(end.theta(), 2);
  }
  return {std::sqrt(sum_x2 / kRuns), std::sqrt(sum_theta2 / kRuns)};
}

TEST(WheelOdometry, StartsAtTheIdentity) {
  WheelOdometry odometry{{}, {}, 1};
  const OdometrySample first = odometry.measure(timestamp_from_us(5), {});
  EXPECT_EQ(first.time, timestamp_from_us(5));
  EXPECT_EQ(first.odom_from_base.x(), 0.0);
  EXPECT_EQ(first.odom_from_base.theta(), 0.0);
}

TEST(WheelOdometry, WithoutErrorsAStraightLineIsExact) {
  const Se2 end = after(no_errors(), 2.0, 2.0, 100);
  EXPECT_NEAR(end.x(), 2.0, 1e-12);
  EXPECT_EQ(end.y(), 0.0);
}

TEST(WheelOdometry, WithoutErrorsAQuarterCircleIsExact) {
  const double radius_m = 1.0;
  const double half_separation_m = 0.287 / 2;
  const double quarter = std::numbers::pi / 2;
  const Se2 end = after(no_errors(), quarter * (radius_m - half_separation_m),
                        quarter * (radius_m + half_separation_m), 500);
  EXPECT_NEAR(end.x(), radius_m, 1e-5);
  EXPECT_NEAR(end.y(), radius_m, 1e-5);
  EXPECT_NEAR(end.theta(), quarter, 1e-12);
}

TEST(WheelOdometry, ScalesStretchDistancesAndTurns) {
  OdometryErrorConfig errors = no_errors();
  errors.scale = 0.01;
  errors.heading_scale = -0.1;
  EXPECT_NEAR(after(errors, 2.0, 2.0, 10).x(), 2.02, 1e-12);
  EXPECT_NEAR(after(errors, -0.287 / 2, 0.287 / 2, 10).theta(), 0.9, 1e-12);
}

TEST(WheelOdometry, DiffusionIsAsConfiguredAndIndependentOfTheRate) {
  OdometryErrorConfig errors = no_errors();
  errors.diffusion_m_per_sqrt_m = 0.003;
  errors.heading_diffusion_deg_per_sqrt_m = 0.5;
  // A sigma from 600 runs has a sigma of 3 %; four are allowed. Sideways drift does not change x.
  for (const int steps : {4, 64}) {
    const Spread seen = spread(errors, 4.0, steps);
    EXPECT_NEAR(seen.sigma_x_m, 0.006, 0.12 * 0.006) << steps;
    EXPECT_NEAR(seen.sigma_theta_rad, radians(1.0), 0.12 * radians(1.0)) << steps;
  }
}

TEST(WheelOdometry, AStandingRobotDoesNotDrift) {
  const Se2 end = after({}, 0.0, 0.0, 1000);
  EXPECT_EQ(end.x(), 0.0);
  EXPECT_EQ(end.theta(), 0.0);
}

TEST(WheelOdometry, TickRoundingDoesNotAccumulate) {
  OdometryErrorConfig errors = no_errors();
  errors.ticks_per_turn = 64;
  const double tick_m = 2 * std::numbers::pi * 0.033 / 64;
  EXPECT_NEAR(after(errors, 1.0, 1.0, 1000).x(), 1.0, 0.5 * tick_m + 1e-12);
}

TEST(WheelOdometry, SlipsLengthenThePath) {
  OdometryErrorConfig errors = no_errors();
  errors.slips_per_m = 5.0;
  errors.slip_m = 0.02;
  double sum_m = 0.0;
  constexpr int kRuns = 200;
  for (int seed = 0; seed < kRuns; ++seed)
    sum_m += after(errors, 4.0, 4.0, 2000, seed).x() - 4.0;
  EXPECT_NEAR(sum_m / kRuns, 5.0 * 4.0 * 0.02, 0.03);  // sigma of the mean: 0.009
}

TEST(WheelOdometry, TheSeedDeterminesSignOfScaleAndSizeOfHeadingScale) {
  EXPECT_EQ(errors_of_seed({}, 1).scale, 0.01);
  EXPECT_EQ(errors_of_seed({}, 2).scale, -0.01);
  for (std::int64_t seed = 0; seed < 50; ++seed)
    EXPECT_LE(std::abs(errors_of_seed({}, seed).heading_scale), 0.005);
  EXPECT_NE(errors_of_seed({}, 3).heading_scale, errors_of_seed({}, 4).heading_scale);
  EXPECT_EQ(errors_of_seed(no_errors(), 3).scale, 0.0);
}

}  // namespace
}  // namespace waymark
