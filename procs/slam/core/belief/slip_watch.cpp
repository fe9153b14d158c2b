// SPDX-License-Identifier: BSD-3-Clause
#include "slam/core/belief/slip_watch.hpp"

#include <algorithm>
#include <cmath>

namespace waymark {
namespace {

constexpr double kSlip = 25.0;  // [sigma^2] more is no noise
constexpr double kOutlier =
    4.0;                        // [sigma^2] more may be the beginning of a slip: no more is learnt
constexpr double kRate = 0.02;  // by an update

/// Squared turn that walls have corrected, over what is expected of it.
double ratio_of(const PoseCorrection& correction, const Motion& motion,
                const OdometryNoise& noise) {
  const double expected_rad2 =
      turn_variance(noise, motion.distance_m, motion.turn_rad) + correction.posterior_variance.z();
  return expected_rad2 > 0.0 ? correction.by.z() * correction.by.z() / expected_rad2 : 0.0;
}

}  // namespace

double SlipWatch::slipped_turn(const PoseCorrection& correction, const Motion& motion,
                               const OdometryNoise& noise) const {
  const double way_m = motion.start_from_end.translation().norm();
  if (way_m < noise.half_track_m * motion.turn_rad) return 0.0;
  const double ratio = ratio_of(correction, motion, noise);
  return ratio > kSlip * ratio_ ? correction.by.z() : 0.0;
}

void SlipWatch::learn(const PoseCorrection& correction, const Motion& motion,
                      const OdometryNoise& noise) {
  const double ratio = ratio_of(correction, motion, noise);
  if (ratio > kSlip * ratio_) return;
  ratio_ = std::max(1.0, ratio_ + kRate * (std::min(ratio, kOutlier * ratio_) - ratio_));
}

}  // namespace waymark
