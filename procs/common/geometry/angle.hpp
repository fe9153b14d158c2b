// SPDX-License-Identifier: BSD-3-Clause
// Angles in radians.
#pragma once

#include <cmath>
#include <numbers>

namespace waymark {

constexpr double radians(double degrees) {
  return degrees * std::numbers::pi / 180.0;
}

constexpr double degrees(double radians) {
  return radians * 180.0 / std::numbers::pi;
}

/// The angle plus the multiple of 2 pi that brings it into (-pi, pi].
inline double wrap_angle(double angle_rad) {
  if (angle_rad > -std::numbers::pi && angle_rad <= std::numbers::pi) return angle_rad;
  const double wrapped = std::remainder(angle_rad, 2.0 * std::numbers::pi);
  return wrapped <= -std::numbers::pi ? std::numbers::pi : wrapped;
}

/// Smallest signed turn from direction `from_rad` to direction `to_rad`, in (-pi, pi].
inline double angle_difference(double to_rad, double from_rad) {
  return wrap_angle(to_rad - from_rad);
}

}  // namespace waymark
