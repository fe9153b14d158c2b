// SPDX-License-Identifier: BSD-3-Clause
// Measured value with uncertainty -> verdict.
#pragma once

#include "doctor/check.hpp"
#include "doctor/motion/hand_eye.hpp"

#include <cmath>

namespace waymark {

/// Deviations up to `warn_above` have no effect; above `fail_above` they damage maps.
struct DeviationLimits {
  double warn_above{0.0};
  double fail_above{0.0};
};

inline constexpr double kSigmas = 3.0;

/// The verdict for the absolute deviation minus three standard deviations.
inline Verdict verdict_of(double deviation, double sigma, DeviationLimits limits) {
  const double certain = std::abs(deviation) - kSigmas * sigma;
  return certain <= limits.warn_above   ? Verdict::kPass
         : certain <= limits.fail_above ? Verdict::kWarn
                                        : Verdict::kFail;
}

/// True when three standard deviations are within the limit `fail_above`.
inline bool is_known(const Measured& measured, DeviationLimits limits) {
  return kSigmas * measured.sigma <= limits.fail_above;
}

/// Whether robot.toml should get the measured value: the described one does not pass the check, or
/// differs by more than three sigmas while the measurement's three sigmas are less than half of
/// `warn_above`.
inline bool is_worth_writing(Verdict verdict, double deviation, double sigma,
                             DeviationLimits limits) {
  constexpr double kMuchBetter = 2.0;
  return verdict != Verdict::kPass || (std::abs(deviation) > kSigmas * sigma &&
                                       kMuchBetter * kSigmas * sigma < limits.warn_above);
}

}  // namespace waymark
