// SPDX-License-Identifier: BSD-3-Clause
// A map that is updated when the poses of its scans change.
#pragma once

#include "slam/core/mapping/mapper.hpp"
#include "slam/core/mapping/scan_archive.hpp"

#include <cstddef>
#include <functional>
#include <vector>

namespace waymark {

/// Keeps the scans that it is drawn from. When their poses change, scans are erased at their old
/// poses and drawn at the new ones, a few at a time. Erasing is exact, since cells count beams.
/// Scans that the archive has emptied are removed from the map.
class DrawnMap {
 public:
  /// @param base_map  map to which the scans are added: a loaded one, or an empty one.
  DrawnMap(const MapperConfig& config, const GridMap& base_map);

  /// Adds the next scan, with its markers.
  /// @throws std::length_error as TileMap does; the scan is not kept then.
  void add(const Observation& observation, const Se2& map_from_base);

  /// To be called after the poses have changed: redraw_some() will check all scans.
  void note_poses_changed() { unchecked_ = scans_.size(); }

  /// Redraws scans that have moved by a cell, a few at each call; markers once all are redrawn.
  /// @param pose_of  map_from_base of a scan, by its number.
  void redraw_some(const std::function<Se2(std::size_t)>& pose_of);

  /// Redraws all scans at once, for a new map frame.
  void redraw_all(const std::function<Se2(std::size_t)>& pose_of);

  /// The same map drawn along other poses.
  GridMap drawn_along(const std::function<Se2(std::size_t)>& pose_of) const;

  const GridMap& map() const { return map_; }

  const ScanArchive& scans() const { return scans_; }

 private:
  void draw_markers(const std::vector<MarkerSighting>& sightings, const Se2& map_from_base,
                    GridMap& map) const;

  MapperConfig config_;
  GridMap base_map_;
  GridMap map_;
  ScanArchive scans_{};
  std::vector<Se2> drawn_at_{};
  std::size_t next_{0};       ///< the scan before this one is checked next; before 0: the newest
  std::size_t unchecked_{0};  ///< number of scans that may have moved
  bool has_moved_{false};     ///< scans were redrawn, the markers not yet
};

}  // namespace waymark
