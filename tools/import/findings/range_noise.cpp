// SPDX-License-Identifier: BSD-3-Clause
#include "import/findings/range_noise.hpp"

#include <algorithm>
#include <cmath>

namespace waymark {
namespace {

constexpr std::size_t kFewestTriples = 1000;
constexpr double kWidest_rad = 0.2;       // between the outer two beams
constexpr double kMedianOfNormal = 0.6745;  // median of the absolute value, in standard deviations
constexpr double kSigmaOfStep = 0.2887;     // of the error of rounding, in steps: 1 / sqrt(12)
constexpr double kSmallestStep_m = 1e-4;    // less is the rounding of a float

bool is_range(double range_m) {
  return std::isfinite(range_m) && range_m > 0.0;
}

}  // namespace

void RangeNoise::add(const LidarScan& scan) {
  for (std::size_t i = 2; i < scan.ranges_m.size(); ++i) {
    const double r_a = scan.ranges_m[i - 2];
    const double r_b = scan.ranges_m[i - 1];
    const double r_c = scan.ranges_m[i];
    const double ab_rad = angle_difference(scan.angles_rad[i - 1], scan.angles_rad[i - 2]);
    const double bc_rad = angle_difference(scan.angles_rad[i], scan.angles_rad[i - 1]);
    if (!is_range(r_a) || !is_range(r_b) || !is_range(r_c)) continue;
    if (ab_rad * bc_rad <= 0.0 || std::abs(ab_rad + bc_rad) > kWidest_rad) continue;
    const double weight_a = std::sin(bc_rad);
    const double weight_b = std::sin(ab_rad + bc_rad);
    const double weight_c = std::sin(ab_rad);
    const double residual = weight_a / r_a + weight_c / r_c - weight_b / r_b;
    const double sigma_per_m = std::hypot(weight_a / (r_a * r_a), weight_b / (r_b * r_b),
                                          weight_c / (r_c * r_c));
    residuals_m_.push_back(std::abs(residual) / sigma_per_m);
    const double step_m = std::abs(r_b - r_a);
    if (step_m > kSmallestStep_m) step_m_ = std::min(step_m_, step_m);
  }
}

std::optional<double> RangeNoise::sigma_m() const {
  if (residuals_m_.size() < kFewestTriples) return std::nullopt;
  std::vector<double> residuals_m = residuals_m_;
  const auto middle = residuals_m.begin() + static_cast<std::ptrdiff_t>(residuals_m.size() / 2);
  std::ranges::nth_element(residuals_m, middle);
  return std::max(*middle / kMedianOfNormal, kSigmaOfStep * step_m_);
}

}  // namespace waymark
