// SPDX-License-Identifier: BSD-3-Clause
#include "slam/core/belief/noise_growth.hpp"

#include <algorithm>
#include <cmath>

namespace waymark {
namespace {

constexpr double kTold = 0.3;       // share of the variance that an update must take away to count
constexpr double kRate = 0.05;      // of the log factor, by an update
constexpr double kExpected = 1.3;   // ratio without growth; 1 would let chance alone inflate
constexpr double kMaxRatio = 10.0;  // one surprise is no habit
constexpr double kMaxFactor = 1000.0;

}  // namespace

void NoiseGrowth::learn(const PoseCorrection& correction) {
  for (int axis = 0; axis < 3; ++axis) {
    const double taken = correction.prior_variance[axis] - correction.posterior_variance[axis];
    if (!(taken > kTold * correction.prior_variance[axis])) continue;
    const double ratio = std::min(correction.by[axis] * correction.by[axis] / taken, kMaxRatio);
    factors_[axis] =
        std::clamp(factors_[axis] * std::exp(kRate * (ratio - kExpected)), 1.0, kMaxFactor);
  }
}

OdometryNoise NoiseGrowth::applied_to(OdometryNoise noise) const {
  const Eigen::Vector3d by = factors_.cwiseSqrt();
  noise.along_per_sqrt_m *= by[0];
  noise.across_per_sqrt_m *= by[1];
  noise.turn_per_sqrt_m *= by[2];
  noise.turn_per_sqrt_rad *= by[2];
  return noise;
}

}  // namespace waymark
