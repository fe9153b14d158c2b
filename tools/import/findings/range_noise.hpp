// SPDX-License-Identifier: BSD-3-Clause
// The noise of a LiDAR's ranges, from its own scans.
#pragma once

#include "common/sensors/sensors.hpp"

#include <optional>
#include <vector>

namespace waymark {

/// Collects how much nine neighbouring beams scatter about the straight wall that fits them best.
class WallScatter {
 public:
  void add(const LidarScan& scan);

  /// Standard deviation of a range [m]. Beams on corners and clutter scatter more than those on
  /// straight walls, by anything: the most frequent scatter (mode of its logarithm) is that of
  /// straight walls, and all scatters up to twice that are averaged. Never below the error of the
  /// step in which ranges are written. nullopt for fewer than 100 walls. What all beams of a scan
  /// have in common is not seen.
  std::optional<double> sigma_m() const;

 private:
  double step_m() const;

  std::vector<double> scatters_m_{};     ///< one per nine beams
  std::vector<double> differences_m_{};  ///< between neighbouring ranges, not 0
};

}  // namespace waymark
