// SPDX-License-Identifier: BSD-3-Clause
#include "detector/core/blurred_side.hpp"

#include <cmath>
#include <numbers>

namespace waymark {
namespace {

constexpr int kSteps = 48;  // samples of a model's profile

double normal_cdf(double x) {
  return 0.5 * std::erfc(-x / std::numbers::sqrt2);
}

}  // namespace

EdgeProfile BlurredSide::profile(double reach_px) const {
  EdgeProfile profile{.reach_px = reach_px};
  for (int k = 0; k <= kSteps; ++k) {
    const double offset_px = reach_px * (2.0 * k / kSteps - 1.0);
    profile.brightness.push_back(normal_cdf(offset_px / blur_px) +
                                 inner_white * normal_cdf((-border_px - offset_px) / blur_px));
  }
  profile.is_white_behind = inner_white > 0.0;
  read_levels(profile, border_px);
  return profile;
}

double BlurredSide::bias_px(double reach_px, double black_level, double half_window_px) const {
  return profile(reach_px).edge_px(black_level, half_window_px).value_or(0.0);
}

}  // namespace waymark
