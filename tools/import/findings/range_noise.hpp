// SPDX-License-Identifier: BSD-3-Clause
// The noise of a LiDAR's ranges, from its own scans.
#pragma once

#include "common/sensors/sensors.hpp"

#include <optional>
#include <vector>

namespace waymark {

/// Fits a straight wall to each group of nine neighbouring beams, and collects their scatter about
/// it.
class WallScatter {
 public:
  void add(const LidarScan& scan);

  /// Standard deviation of a range [m]. Beams on corners and clutter have a larger scatter: the
  /// most frequent scatter (mode of its logarithm) is that of straight walls, and all scatters up
  /// to twice that are averaged. Not below the rounding error of the ranges. nullopt for fewer than
  /// 100 walls. Errors that all beams of a scan have in common are not included.
  std::optional<double> sigma_m() const;

 private:
  double step_m() const;

  std::vector<double> scatters_m_{};     ///< one per nine beams
  std::vector<double> differences_m_{};  ///< between neighbouring ranges, not 0
};

}  // namespace waymark
