// SPDX-License-Identifier: BSD-3-Clause
#include "slam/core/gmapping/motion_noise.hpp"

#include <cmath>

namespace waymark {
namespace {

/// Share of srr that acts across the motion; fixed in the released code.
constexpr double kAcross = 0.3;

}  // namespace

Se2 sample_step(const Se2& start_from_end, const StepNoise& noise, Random& random) {
  const double dx_m = std::abs(start_from_end.x());
  const double dy_m = std::abs(start_from_end.y());
  const double turn_rad = std::abs(start_from_end.theta());
  const double sigma_x_m = noise.srr * (dx_m + kAcross * dy_m) + noise.str * turn_rad;
  const double sigma_y_m = noise.srr * (dy_m + kAcross * dx_m) + noise.str * turn_rad;
  const double sigma_theta_rad = noise.stt * turn_rad + noise.srt * std::hypot(dx_m, dy_m);
  const double x_m = random.normal(start_from_end.x(), sigma_x_m);
  const double y_m = random.normal(start_from_end.y(), sigma_y_m);
  return {x_m, y_m, random.normal(start_from_end.theta(), sigma_theta_rad)};
}

}  // namespace waymark
