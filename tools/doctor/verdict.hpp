// SPDX-License-Identifier: BSD-3-Clause
// Measured value with uncertainty -> verdict.
#pragma once

#include "doctor/check.hpp"
#include "doctor/motion/hand_eye.hpp"

#include <cmath>

namespace waymark {

/// Deviations up to `good` have no effect; beyond `bad` they damage maps.
struct Limits {
  double good{0.0};
  double bad{0.0};
};

inline constexpr double kSigmas = 3.0;

/// The verdict for the absolute deviation minus three standard deviations.
inline Verdict verdict_of(double deviation, double sigma, Limits limits) {
  const double certain = std::abs(deviation) - kSigmas * sigma;
  return certain <= limits.good  ? Verdict::kPass
         : certain <= limits.bad ? Verdict::kWarn
                                 : Verdict::kFail;
}

/// True when three standard deviations are within the limit `bad`.
inline bool is_known(const Measured& measured, Limits limits) {
  return kSigmas * measured.sigma <= limits.bad;
}

/// Whether a measured value should replace the described one: the verdict is against the described
/// one, or the two differ clearly and the measurement is much more accurate than the limit `good`.
inline bool is_worth_writing(Verdict verdict, double deviation, double sigma, Limits limits) {
  constexpr double kMuchBetter = 2.0;
  return verdict != Verdict::kPass ||
         (std::abs(deviation) > kSigmas * sigma && kMuchBetter * kSigmas * sigma < limits.good);
}

}  // namespace waymark
