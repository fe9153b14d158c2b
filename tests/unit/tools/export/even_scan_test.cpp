// SPDX-License-Identifier: BSD-3-Clause
#include "export/even_scan.hpp"

#include "common/geometry/angle.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace waymark::exporting {
namespace {

using ::testing::ElementsAre;

constexpr float kNoReturn = std::numeric_limits<float>::infinity();

double angle_of_place(const EvenScan& scan, std::size_t place) {
  const double steps = static_cast<double>(scan.ranges_m.size() - 1);
  return scan.start_angle_rad +
         static_cast<double>(place) * (scan.end_angle_rad - scan.start_angle_rad) / steps;
}

TEST(EvenScan, EvenBeamsStayAsTheyAre) {
  const EvenScan scan =
      even_scan(std::vector{-0.5F, 0.0F, 0.5F}, std::vector{1.0F, kNoReturn, std::nanf("")});
  EXPECT_EQ(scan.start_angle_rad, -0.5);
  EXPECT_EQ(scan.end_angle_rad, 0.5);
  EXPECT_THAT(scan.ranges_m, ElementsAre(1.0F, 0.0F, 0.0F));
}

TEST(EvenScan, ClockwiseBeamsAreReversed) {
  const EvenScan scan = even_scan(std::vector{0.5F, 0.0F, -0.5F}, std::vector{1.0F, 2.0F, 3.0F});
  EXPECT_EQ(scan.start_angle_rad, -0.5);
  EXPECT_EQ(scan.end_angle_rad, 0.5);
  EXPECT_THAT(scan.ranges_m, ElementsAre(3.0F, 2.0F, 1.0F));
}

TEST(EvenScan, BeamsMayCrossTheEndOfTheTurn) {
  const EvenScan scan = even_scan(std::vector{6.1F, 6.2F, 0.01681F}, std::vector{1.0F, 2.0F, 3.0F});
  EXPECT_NEAR(scan.start_angle_rad, 6.1, 1e-6);
  EXPECT_NEAR(scan.end_angle_rad, 6.3, 1e-5);
  EXPECT_THAT(scan.ranges_m, ElementsAre(1.0F, 2.0F, 3.0F));
}

// Beams as of the MBot: clockwise from just below zero, uneven, slightly more than one turn.
TEST(EvenScan, UnevenBeamsKeepTheirDirections) {
  constexpr int kBeams = 300;
  constexpr double kSpacing = 0.021;
  std::vector<float> angles;
  std::vector<float> ranges;
  for (int i = 0; i < kBeams; ++i) {
    const double angle = -6.27 - kSpacing * (i + 0.4 * std::sin(0.7 * i));
    angles.push_back(static_cast<float>(std::remainder(angle, 2.0 * std::numbers::pi)));
    ranges.push_back(static_cast<float>(1 + i));
  }
  const EvenScan scan = even_scan(angles, ranges);
  int num_found = 0;
  for (std::size_t place = 0; place < scan.ranges_m.size(); ++place) {
    if (scan.ranges_m[place] == 0.0F) continue;
    ++num_found;
    const auto beam = static_cast<std::size_t>(scan.ranges_m[place]) - 1;
    EXPECT_NEAR(angle_difference(angle_of_place(scan, place), angles[beam]), 0.0, kSpacing / 7)
        << beam;
  }
  EXPECT_EQ(num_found, kBeams);
}

TEST(EvenScan, OfTwoBeamsAtOnePlaceTheNearerOneIsKept) {
  const EvenScan scan = even_scan(std::vector{0.0F, 0.005F, 0.5F, 1.0F, 1.0F},
                                  std::vector{kNoReturn, 2.0F, 3.0F, 4.0F, 5.0F});
  EXPECT_EQ(scan.ranges_m.size(), 20U);
  EXPECT_EQ(scan.ranges_m.front(), 2.0F);
  EXPECT_EQ(scan.ranges_m.back(), 4.0F);
}

TEST(EvenScan, OneBeamIsAScan) {
  const EvenScan scan = even_scan(std::vector{0.3F}, std::vector{2.0F});
  EXPECT_EQ(scan.start_angle_rad, scan.end_angle_rad);
  EXPECT_THAT(scan.ranges_m, ElementsAre(2.0F));
}

}  // namespace
}  // namespace waymark::exporting
