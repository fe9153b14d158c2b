// SPDX-License-Identifier: BSD-3-Clause
// Global localisation in a loaded map, by walls alone.
#pragma once

#include "slam/core/localisation/map_snapshot.hpp"
#include "slam/core/motion/motion.hpp"
#include "slam/core/registration/correlative_search.hpp"
#include "slam/core/registration/scan_match.hpp"
#include "slam/core/scan/observation.hpp"

#include <memory>
#include <optional>

namespace waymark {

/// Searches the whole map for a scan every 0.4 m of driving. A scan counts if it fits at one place
/// only and observes every direction, unlike in a bare corridor. The pose is decided when three
/// such scans in a row are consistent with the odometry between them.
class WallPlaceFinder {
 public:
  WallPlaceFinder(std::shared_ptr<const MapSnapshot> map, const ScanMatchConfig& scan);

  /// To be called with every motion, also those without search().
  void follow(const Motion& motion);

  /// @return map_from_base, once decided.
  std::optional<Se2> search(const Observation& observation, const RangeNoise& noise);

 private:
  std::optional<Se2> found(const Points& points, const RangeNoise& noise) const;

  std::shared_ptr<const MapSnapshot> map_;
  ScanMatchConfig scan_;
  std::optional<CorrelativeField> field_{};  ///< of the map's walls; none: the map has no walls
  Se2 middle_{};
  SearchWindow window_{};
  double since_search_m_{1e9};
  std::optional<Se2> candidate_{};  ///< map_from_base, propagated by odometry
  int num_consistent_{0};           ///< scans in a row, the candidate's included
};

}  // namespace waymark
