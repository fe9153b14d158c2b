// SPDX-License-Identifier: BSD-3-Clause
// Odometry that comes once per scan, with the scan's stamp, as in CARMEN's logs: an offset between
// two samples is less exact than all parts of the log, which agree, make believe.
#include "doctor/motion/hand_eye.hpp"
#include "synthetic_drive.hpp"

#include <gtest/gtest.h>

namespace waymark {
namespace {

constexpr int kStep_us = 20'000;  // of the synthetic drive
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

TEST(DoctorTimeOffset, OfSeldomOdometryIsWithinItsSigmas) {
  for (const int period_steps : {5, 10}) {
    for (int late_steps = -period_steps; late_steps <= period_steps; ++late_steps) {
      const Measured late = seldom_comparison(late_steps, period_steps).lidar_late_s;
      EXPECT_NEAR(late.value, 1e-6 * kStep_us * late_steps, kSigmasOfATest * late.sigma)
          << late_steps << " steps late, a sample each " << period_steps;
    }
  }
}

TEST(DoctorTimeOffset, BetweenSeldomSamplesIsLessCertainThanOnOne) {
  const Measured on_a_sample = seldom_comparison(10, 10).lidar_late_s;
  const Measured between = seldom_comparison(7, 10).lidar_late_s;
  EXPECT_LT(on_a_sample.sigma, 0.003);
  EXPECT_GT(between.sigma, 0.01);
  EXPECT_GT(between.value - kSigmasOfATest * between.sigma, 0.02) << "an offset all the same";
}

}  // namespace
}  // namespace waymark
