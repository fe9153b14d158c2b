// SPDX-License-Identifier: BSD-3-Clause
// The noise of a LiDAR's ranges, from its own scans.
#pragma once

#include "common/sensors/sensors.hpp"

#include <optional>
#include <vector>

namespace waymark {

/// Collects how far neighbouring beams are from a straight wall.
///
/// The inverse range of a straight line is A cos(angle) + B sin(angle), so of three beams at angles
/// a < b < c it is sin(c-b)/r_a + sin(b-a)/r_c = sin(c-a)/r_b. The difference, divided by its
/// standard deviation for ranges with a noise of 1 m, is distributed with the noise itself.
class RangeNoise {
 public:
  void add(const LidarScan& scan);

  /// Standard deviation of a range [m]: median of the absolute residuals, which beams on edges and
  /// clutter disturb little, but never below a third of the step in which ranges are written.
  /// nullopt for fewer than 1000 triples. What all beams of a scan have in common is not seen.
  std::optional<double> sigma_m() const;

 private:
  std::vector<double> residuals_m_{};  ///< absolute
  double step_m_{1.0};                 ///< smallest difference between neighbouring ranges
};

}  // namespace waymark
