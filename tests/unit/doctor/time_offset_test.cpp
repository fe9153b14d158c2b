// SPDX-License-Identifier: BSD-3-Clause
// Measurement of the delay of the LiDAR's stamps, with many samples of odometry between two scans,
// and with one per scan, at the scan's stamp, as in CARMEN logs.
#include "doctor/motion/hand_eye.hpp"
#include "synthetic_drive.hpp"

#include <gtest/gtest.h>

namespace waymark {
namespace {

constexpr int kStep_us = 20'000;  // time step of the synthetic drive
constexpr double kSigmasOfATest = 3.0;

/// @param period_steps  between samples of odometry, and between scans
TurnComparison seldom_comparison(int late_steps, int period_steps) {
  DoctorInput input = drive_in_room({.lidar_late_s = 1e-6 * kStep_us * late_steps});
  const auto is_dropped = [&](const auto& record) {
    return (to_us(record.time) / kStep_us - late_steps) % period_steps != 0;
  };
  std::erase_if(input.log.odometry, is_dropped);
  std::erase_if(input.log.scans, is_dropped);
  return compare_turns(lidar_motions(input.log).turns, input.log.odometry).value();
}

TEST(DoctorTimeOffset, AnOffsetBetweenSamplesIsMeasuredToThreeMilliseconds) {
  for (const double late_s : {-0.047, -0.013, 0.0, 0.013, 0.034}) {
    const DoctorInput input = drive_in_room({.lidar_late_s = late_s, .odometry_noise_rad = 0.0005});
    const Measured found =
        compare_turns(lidar_motions(input.log).turns, input.log.odometry).value().lidar_late_s;
    EXPECT_NEAR(found.value, late_s, 0.003);
    EXPECT_NEAR(found.value, late_s, kSigmasOfATest * found.sigma + 0.001);
    EXPECT_LT(found.sigma, 0.003);
  }
}

TEST(DoctorTimeOffset, AtLowSampleRatesTheErrorIsWithinItsSigmas) {
  for (const int period_steps : {5, 10}) {
    for (int late_steps = -period_steps; late_steps <= period_steps; ++late_steps) {
      const Measured late = seldom_comparison(late_steps, period_steps).lidar_late_s;
      EXPECT_NEAR(late.value, 1e-6 * kStep_us * late_steps, kSigmasOfATest * late.sigma)
          << late_steps << " steps late, a sample each " << period_steps;
    }
  }
}

TEST(DoctorTimeOffset, AtVeryLowSampleRatesALargeOffsetIsSignificant) {
  for (const int late_steps : {7, 10}) {
    const Measured late = seldom_comparison(late_steps, 10).lidar_late_s;
    EXPECT_LT(late.sigma, 0.01);
    EXPECT_GT(late.value - kSigmasOfATest * late.sigma, 0.02) << "an offset all the same";
  }
}

}  // namespace
}  // namespace waymark
