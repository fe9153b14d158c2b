// SPDX-License-Identifier: BSD-3-Clause
// Where in a loaded map the robot is, by walls alone.
#pragma once

#include "slam/core/graph/map_snapshot.hpp"
#include "slam/core/motion/motion.hpp"
#include "slam/core/registration/correlative_search.hpp"
#include "slam/core/registration/scan_match.hpp"
#include "slam/core/scan/observation.hpp"

#include <memory>
#include <optional>

namespace waymark {

/// Looks for each scan in the whole map. A scan counts where it fits at one place only and shows
/// every direction, which a bare corridor never does; the place is decided when scans from places
/// that are apart have agreed with each other, by odometry.
class WallPlaceFinder {
 public:
  WallPlaceFinder(std::shared_ptr<const MapSnapshot> map, const ScanMatchConfig& scan);

  /// @param motion  since the last call.
  /// @return map_from_base, once it is decided.
  std::optional<Se2> update(const Motion& motion, const Observation& observation,
                            const RangeNoise& noise);

 private:
  std::optional<Se2> found(const Points& points, const RangeNoise& noise) const;

  std::shared_ptr<const MapSnapshot> map_;
  ScanMatchConfig scan_;
  std::optional<CorrelativeField> field_{};  ///< of the map's walls; none: it has none
  Se2 middle_{};
  SearchWindow window_{};
  double since_search_m_{1e9};
  std::optional<Se2> candidate_{};  ///< map_from_base, carried on by odometry
  int agreed_{0};                   ///< scans, with the candidate
};

}  // namespace waymark
