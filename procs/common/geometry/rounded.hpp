// SPDX-License-Identifier: BSD-3-Clause
// Rounding for texts.
#pragma once

#include <cmath>

namespace waymark {

/// To a multiple of 1 / per_unit; zero has no minus.
inline double rounded(double value, double per_unit) {
  return std::round(per_unit * value) / per_unit + 0.0;  // -0.0 + 0.0 is +0.0
}

}  // namespace waymark
