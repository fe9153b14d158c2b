// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace waymark {

/// How far LiDAR points scatter across walls, as described.
class RangeNoise {
 public:
  explicit RangeNoise(double sigma_m) : variance_m2_{sigma_m * sigma_m} {}

  double variance_m2() const { return variance_m2_; }

 private:
  double variance_m2_;
};

}  // namespace waymark
