// SPDX-License-Identifier: BSD-3-Clause
#include "import/findings/range_noise.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace waymark {
namespace {

/// A room of 8 m x 6 m with the LiDAR off its middle; ranges with noise, written in steps.
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
  RangeNoise noise;
  for (int i = 0; i < 40; ++i)
    noise.add(room(sigma_m, step_m, random));
  return noise.sigma_m().value_or(-1.0);
}

TEST(RangeNoise, IsThatOfTheRangesFromMillimetresToDecimetres) {
  for (const double sigma_m : {0.003, 0.01, 0.03, 0.1})
    EXPECT_NEAR(estimated_sigma_m(sigma_m), sigma_m, 0.1 * sigma_m) << sigma_m;
}

TEST(RangeNoise, IsNotBelowThatOfRounding) {
  EXPECT_NEAR(estimated_sigma_m(0.0, 0.01), 0.01 / std::sqrt(12.0), 0.002);
}

TEST(RangeNoise, MissingRangesAreLeftOutAndFewGiveNothing) {
  std::mt19937 random{3};
  LidarScan scan = room(0.01, 1e-3, random);
  RangeNoise few;
  few.add(scan);
  EXPECT_FALSE(few.sigma_m());

  RangeNoise noise;
  for (std::size_t i = 0; i < scan.ranges_m.size(); i += 10)
    scan.ranges_m[i] = i % 20 == 0 ? std::numeric_limits<double>::infinity() : std::nan("");
  for (int i = 0; i < 10; ++i)
    noise.add(scan);
  EXPECT_NEAR(noise.sigma_m().value_or(-1.0), 0.01, 0.003);
}

TEST(RangeNoise, DoesNotDependOnTheSenseOfRotation) {
  std::mt19937 random{5};
  RangeNoise forwards, backwards;
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
