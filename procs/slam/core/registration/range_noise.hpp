// SPDX-License-Identifier: BSD-3-Clause
// Learns the noise of the LiDAR's ranges.
#pragma once

#include <algorithm>

namespace waymark {

/// Variance of LiDAR points across walls: that of the description, updated with residuals.
class RangeNoise {
 public:
  explicit RangeNoise(double described_sigma_m)
      : sum_m2_{kDescribedPoints * described_sigma_m * described_sigma_m},
        weight_{kDescribedPoints} {}

  /// @param across_m2  mean square of points about a fitted line, `count` of them.
  void observe(double across_m2, int count) {
    sum_m2_ += count * across_m2;
    weight_ += count;
    const double keeps = std::min(1.0, kMaxPooled / weight_);
    sum_m2_ *= keeps;
    weight_ *= keeps;
  }

  double variance_m2() const { return sum_m2_ / weight_; }

 private:
  static constexpr double kDescribedPoints = 200.0;  ///< weight of the description: about one scan
  static constexpr double kMaxPooled = 2e5;          ///< largest weight; older points fade

  double sum_m2_;
  double weight_;
};

}  // namespace waymark
