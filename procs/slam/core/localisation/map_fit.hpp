// SPDX-License-Identifier: BSD-3-Clause
// Whether a scan contradicts a map.
#pragma once

#include "common/geometry/se2.hpp"
#include "slam/core/grid/grid_map.hpp"
#include "slam/core/scan/annotated_scan.hpp"

#include <algorithm>
#include <span>

namespace waymark {

inline constexpr double kWallOccupancy = 0.4;  ///< least occupancy of a wall
inline constexpr double kFreeOccupancy = 0.1;  ///< largest occupancy of free space

/// A scan's beams compared with a map. Beams that end in unmapped or uncertain cells count as
/// neither fitting nor contradicting.
struct MapFit {
  int beams{0};          ///< number of compared beams
  int fitting{0};        ///< end on a mapped wall
  int contradicting{0};  ///< cross a mapped wall, or end where the map is free
  int crossing{0};       ///< of these, cross a mapped wall: nobody in the way explains that

  static constexpr int kMinBeams = 20;  ///< fitting and contradicting beams; fewer are not decisive
  static constexpr double kMaxMisfit = 0.3;  ///< misfit() of a correct map at the correct pose

  /// The same of crossing / (fitting + crossing): less than that at correct poses in fr079 and
  /// aces, also among people; more than that in most scans at wrong ones.
  static constexpr double kMaxCrossing = 0.2;

  bool is_decisive() const { return fitting + contradicting >= kMinBeams; }

  /// Contradicting beams / (fitting + contradicting beams), 0 to 1.
  double misfit() const {
    return static_cast<double>(contradicting) / std::max(1, fitting + contradicting);
  }

  bool is_contradicted() const { return is_decisive() && misfit() >= kMaxMisfit; }

  /// The pose or the map is wrong, whoever stands around the robot.
  bool is_refuted() const {
    return is_decisive() && crossing > kMaxCrossing * (fitting + crossing);
  }
};

/// Compares at most 120 beams, evenly spread over the scan.
MapFit fit_in_map(const GridMap& map, std::span<const AnnotatedBeam> beams,
                  const Se2& map_from_base);

}  // namespace waymark
