// SPDX-License-Identifier: BSD-3-Clause
#include "detector/core/blurred_side.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace waymark {
namespace {

constexpr int kSteps = 48;  // samples of a model's profile
// The area of the pixels and the interpolation between them blur like a box of this width; kSharpPx
// is the EdgeProfile::blur_px() of an edge that nothing else blurs. The lens's blur is a Gaussian.
constexpr double kPixelSpread = 1.73;
constexpr double kLeastLensPx = 0.1;
constexpr int kBisections = 12;
constexpr double kUpperQuartile = 0.75;

/// Integral of the normal distribution's cumulative function.
double normal_cdf_integral(double x, double sigma) {
  const double u = x / sigma;
  return 0.5 * x * std::erfc(-u / std::numbers::sqrt2) +
         sigma * std::exp(-0.5 * u * u) / std::sqrt(2.0 * std::numbers::pi);
}

/// Brightness at an offset from a step from 0 to 1, blurred by pixels and lens.
double blurred_step(double offset_px, double lens_px) {
  return (normal_cdf_integral(offset_px + 0.5 * kPixelSpread, lens_px) -
          normal_cdf_integral(offset_px - 0.5 * kPixelSpread, lens_px)) /
         kPixelSpread;
}

/// Blur of the lens alone, with which an edge has this EdgeProfile::blur_px().
double lens_blur_px(double blur_px) {
  const double upper_quartile_px = 0.5 * kQuartileDistance * blur_px;
  double low_px = kLeastLensPx;
  double high_px = std::max(kLeastLensPx, blur_px);
  for (int i = 0; i < kBisections; ++i) {
    const double middle_px = 0.5 * (low_px + high_px);
    const bool is_sharper = blurred_step(upper_quartile_px, middle_px) > kUpperQuartile;
    (is_sharper ? low_px : high_px) = middle_px;
  }
  return low_px;
}

}  // namespace

EdgeProfile BlurredSide::profile(double reach_px) const {
  EdgeProfile profile{.reach_px = reach_px};
  const double lens_px = lens_blur_px(blur_px);
  for (int k = 0; k <= kSteps; ++k) {
    const double offset_px = reach_px * (2.0 * k / kSteps - 1.0);
    profile.brightness.push_back(blurred_step(offset_px, lens_px) +
                                 inner_white * blurred_step(-border_px - offset_px, lens_px) -
                                 (1.0 - outer_white) *
                                     blurred_step(offset_px - border_px, lens_px));
  }
  profile.is_white_behind = inner_white > 0.0;
  profile.is_white_beyond = outer_white > 1.0 - kSameGrey;
  read_levels(profile, border_px);
  return profile;
}

}  // namespace waymark
