// SPDX-License-Identifier: BSD-3-Clause
// What a standard deviation that people give may be.
#pragma once

namespace waymark {

/// [m] or [rad]: its variance, and the inverse of that, are numbers that can be reckoned with.
inline constexpr double kSmallestSigma = 1e-6;
inline constexpr double kLargestSigma = 1e6;

}  // namespace waymark
