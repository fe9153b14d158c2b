// SPDX-License-Identifier: BSD-3-Clause
// Rounding of numbers that are printed.
#pragma once

#include <cmath>

namespace waymark {

/// Nearest multiple of 1 / per_unit; never -0.0.
inline double rounded(double value, double per_unit) {
  return std::round(per_unit * value) / per_unit + 0.0;  // -0.0 + 0.0 = +0.0
}

}  // namespace waymark
