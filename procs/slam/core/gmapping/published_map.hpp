// SPDX-License-Identifier: BSD-3-Clause
// The published map: all scans redrawn, with free space, along the best particle's trajectory.
#pragma once

#include "slam/core/gmapping/trajectory.hpp"
#include "slam/core/grid/grid_map.hpp"

namespace waymark {

/// Draws a scan: a beam visits the cells up to its end, and hits the last one. A beam of
/// `usable_range_m` or more visits the cells before that range and hits none.
void draw_scan(const StoredScan& scan, const Se2& map_from_base, double usable_range_m,
               GridMap& map);

/// The result equals drawing the whole trajectory into an empty map; only new scans are drawn.
class PublishedMap {
 public:
  PublishedMap(const GridFrame& frame, double usable_range_m, double occupied_threshold);

  /// Once all particles descend from `trunk`'s newest node: draws the trunk permanently, and frees
  /// its scans and all of its nodes but the newest.
  void finalise(const Trajectory& trunk);

  /// The map along a trajectory as slam_gmapping publishes it: a mapped cell has one visit, and a
  /// hit if the share of beams that ended in it exceeds the threshold. If the trajectory continues
  /// the previous one, only its new scans are drawn. Unchanged tiles keep their address.
  const GridMap& along(const Trajectory& trajectory);

 private:
  void draw(const Trajectory& trajectory);
  void apply_threshold(TileIndex tile);

  GridMap final_;             ///< along the trunk, which all trajectories share
  GridMap drawn_;             ///< along the last trajectory asked for
  GridMap thresholded_from_;  ///< the drawn_ that thresholded_ was computed from
  GridMap thresholded_;       ///< drawn_ after the threshold
  Trajectory drawn_until_{};  ///< newest node in drawn_
  double usable_range_m_;
  double occupied_threshold_;
};

}  // namespace waymark
