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
inline Verdict judge(double deviation, double sigma, Limits limits) {
  const double certain = std::abs(deviation) - kSigmas * sigma;
  return certain <= limits.good  ? Verdict::kPass
         : certain <= limits.bad ? Verdict::kWarn
                                 : Verdict::kFail;
}

/// Well enough to tell good from bad.
inline bool is_known(const Measured& measured, Limits limits) {
  return kSigmas * measured.sigma <= limits.bad;
}

}  // namespace waymark
