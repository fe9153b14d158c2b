// SPDX-License-Identifier: BSD-3-Clause
#include "import/findings/range_noise.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace waymark {
namespace {

/// A scan in a room of 8 m x 6 m, with noise, its ranges rounded to steps.
LidarScan room(double sigma_m, double step_m, std::mt19937& random) {
  std::normal_distribution<double> noise{0.0, 1.0};
  LidarScan scan{};
  for (int i = 0; i < 360; ++i) {
    const double angle_rad = radians(i - 179.5);
    const double to_x_m = (std::cos(angle_rad) > 0.0 ? 5.0 : 3.0) / std::abs(std::cos(angle_rad));
    const double to_y_m = (std::sin(angle_rad) > 0.0 ? 2.0 : 4.0) / std::abs(std::sin(angle_rad));
    const double range_m = std::min(to_x_m, to_y_m) + sigma_m * noise(random);
    scan.angles_rad.push_back(angle_rad);
    scan.ranges_m.push_back(step_m * std::round(range_m / step_m));
  }
  return scan;
}

double estimated_sigma_m(double sigma_m, double step_m = 1e-3) {
  std::mt19937 random{3};
  WallScatter noise;
  for (int i = 0; i < 40; ++i)
    noise.add(room(sigma_m, step_m, random));
  return noise.sigma_m().value_or(-1.0);
}

TEST(WallScatter, RangeNoiseIsEstimatedFromMillimetresToADecimetre) {
  for (const double sigma_m : {0.003, 0.01, 0.03, 0.1})
    EXPECT_NEAR(estimated_sigma_m(sigma_m), sigma_m, 0.1 * sigma_m) << sigma_m;
}

TEST(WallScatter, ClutterInHalfOfTheBeamsDoesNotRaiseTheNoise) {
  for (const double sigma_m : {0.005, 0.02}) {
    std::mt19937 random{9};
    std::uniform_real_distribution<double> depth{-1.0, 1.0};
    std::uniform_real_distribution<double> log_extent{std::log(0.03), std::log(2.0)};
    WallScatter noise;
    for (int i = 0; i < 60; ++i) {
      LidarScan scan = room(sigma_m, 1e-3, random);
      double extent_m = 0.0;  // depth of the object that the next ten beams hit
      for (std::size_t beam = 0; beam < 200; ++beam) {
        if (beam % 10 == 0) extent_m = std::exp(log_extent(random));
        scan.ranges_m[beam] += extent_m * depth(random);
      }
      noise.add(scan);
    }
    EXPECT_NEAR(noise.sigma_m().value_or(-1.0), sigma_m, 0.2 * sigma_m);
  }
}

TEST(WallScatter, RoundingOfRangesCountsAsNoise) {
  EXPECT_NEAR(estimated_sigma_m(0.0, 0.01), 0.01 / std::sqrt(12.0), 5e-4);
  EXPECT_NEAR(estimated_sigma_m(0.01, 0.05), std::hypot(0.01, 0.05 / std::sqrt(12.0)), 2e-3);
}

TEST(WallScatter, MissingRangesAreSkippedAndTooFewGiveNothing) {
  std::mt19937 random{3};
  LidarScan scan = room(0.01, 1e-3, random);
  WallScatter few;
  few.add(scan);
  EXPECT_FALSE(few.sigma_m());

  WallScatter noise;
  for (std::size_t i = 0; i < scan.ranges_m.size(); i += 10)
    scan.ranges_m[i] = i % 20 == 0 ? std::numeric_limits<double>::infinity() : std::nan("");
  for (int i = 0; i < 10; ++i)
    noise.add(scan);
  EXPECT_NEAR(noise.sigma_m().value_or(-1.0), 0.01, 0.003);
}

TEST(WallScatter, DoesNotDependOnTheSenseOfRotation) {
  std::mt19937 random{5};
  WallScatter forwards, backwards;
  for (int i = 0; i < 10; ++i) {
    LidarScan scan = room(0.02, 1e-3, random);
    forwards.add(scan);
    std::reverse(scan.ranges_m.begin(), scan.ranges_m.end());
    std::reverse(scan.angles_rad.begin(), scan.angles_rad.end());
    backwards.add(scan);
  }
  EXPECT_NEAR(forwards.sigma_m().value(), backwards.sigma_m().value(), 1e-9);
}

}  // namespace
}  // namespace waymark
