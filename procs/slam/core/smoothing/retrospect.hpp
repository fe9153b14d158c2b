// SPDX-License-Identifier: BSD-3-Clause
// The drive as it looks from now: its way, corrected, and the map drawn along it.
#pragma once

#include "slam/core/mapping/mapper.hpp"
#include "slam/core/smoothing/hindsight.hpp"
#include "slam/core/smoothing/scan_archive.hpp"

namespace waymark {

class Retrospect {
 public:
  /// @param observation  what is to be drawn again of this update; may be empty.
  void add_update(const PoseByStatics& by, const Statics& then, const Observation& observation,
                  const Se2& map_from_base) {
    hindsight_.add_update(by, then);
    archive_.add(observation, map_from_base);
  }

  void add_scan(Timestamp time, const Se2& map_from_base) {
    hindsight_.add_scan(time, map_from_base);
  }

  /// As Hindsight::way().
  std::vector<TimedPose> trajectory(const Statics& now, double same_marker_within_m) const {
    return hindsight_.way(now, same_marker_within_m);
  }

  GridMap redrawn_map(const MapperConfig& grid, const Statics& now,
                      double same_marker_within_m) const;

 private:
  Hindsight hindsight_{};
  ScanArchive archive_{};
};

}  // namespace waymark
