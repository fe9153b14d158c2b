// SPDX-License-Identifier: BSD-3-Clause
#include "slam/core/odometry/unmeasured_motion.hpp"

#include <algorithm>
#include <cmath>

namespace waymark {
namespace {

// Slower is standing: odometry with a gyro is never quite still.
constexpr double kStill_m_s = 0.002;
constexpr double kStill_rad_s = 0.005;
constexpr double kSpeedMemory_s = 1.0;
// Odometry that begins anew together with its clock: how long it was silent is not known.
constexpr double kUnknownPause_s = 10.0;
constexpr double kStuckShare = 0.05;  // probability that odometry that stops is stuck; chosen
constexpr double kLongestStandstill_s = 20.0;  // after that the robot is parked

}  // namespace

void UnmeasuredMotion::follow(const Observation& observation) {
  const double elapsed_s = observation.elapsed_s;
  is_standing_ = observation.motion.distance_m <= kStill_m_s * elapsed_s &&
                 observation.motion.turn_rad <= kStill_rad_s * elapsed_s;
  is_jumping_ = observation.odometry_jumped && !observation.odometry_caught_up;
  if (observation.odometry_caught_up) {
    note_observed();
    is_stuck_ = false;
  } else if (is_unreliable()) {
    if (observation.clock_set != Duration{}) unreliable_s_ += kUnknownPause_s;
    is_stuck_ = is_stuck_ && is_standing_;
    unreliable_s_ += elapsed_s;
  } else if (is_standing_) {
    standing_s_ += elapsed_s;
  } else {
    standing_s_ = 0.0;
    if (elapsed_s <= 0.0) return;
    const double share = std::min(1.0, elapsed_s / kSpeedMemory_s);
    speed_m_s_ += share * (observation.motion.distance_m / elapsed_s - speed_m_s_);
  }
}

void UnmeasuredMotion::note_moved(double distance_m, double elapsed_s) {
  is_stuck_ = is_standing_;
  if (is_stuck_ && elapsed_s > 0.0) speed_m_s_ = distance_m / elapsed_s;
}

double UnmeasuredMotion::take_unmeasured_m() {
  const double sigma_m = unmeasured_m();
  unreliable_s_ = 0.0;
  return sigma_m;
}

double UnmeasuredMotion::possibly_stuck_m() const {
  return std::sqrt(kStuckShare) * speed_m_s_ * std::min(standing_s_, kLongestStandstill_s);
}

}  // namespace waymark
