// SPDX-License-Identifier: BSD-3-Clause
// From a number with its uncertainty to a verdict.
#pragma once

#include "doctor/check.hpp"
#include "doctor/motion/hand_eye.hpp"

#include <cmath>

namespace waymark {

/// Up to the first one nothing suffers; beyond the second one maps do.
struct Limits {
  double good{0.0};
  double bad{0.0};
};

inline constexpr double kSigmas = 3.0;

/// Deviations within the limit, or within what chance explains, pass.
inline Verdict verdict_of(double deviation, double sigma, Limits limits) {
  const double certain = std::abs(deviation) - kSigmas * sigma;
  return certain <= limits.good  ? Verdict::kPass
         : certain <= limits.bad ? Verdict::kWarn
                                 : Verdict::kFail;
}

/// Well enough to tell good from bad.
inline bool is_known(const Measured& measured, Limits limits) {
  return kSigmas * measured.sigma <= limits.bad;
}

/// What a description is replaced by: what contradicts it, and what is known much better than a
/// description has to be.
inline bool is_worth_writing(double deviation, double sigma, Limits limits) {
  constexpr double kMuchBetter = 2.0;
  return std::abs(deviation) > kSigmas * sigma || kMuchBetter * kSigmas * sigma < limits.good;
}

}  // namespace waymark
