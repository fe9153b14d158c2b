// SPDX-License-Identifier: BSD-3-Clause
// A map that follows the poses of its scans.
#pragma once

#include "slam/core/mapping/mapper.hpp"
#include "slam/core/mapping/scan_archive.hpp"

#include <cstddef>
#include <functional>
#include <vector>

namespace waymark {

/// Holds the scans that it is drawn from. When their poses change, scans are taken out of it where
/// they were and drawn again where they are, a few at a time: cells count beams, so that this is
/// exact. What is not in the archive any more is not in the map.
class DrawnMap {
 public:
  /// @param ground  that it is drawn upon: a loaded map, or an empty one.
  DrawnMap(const MapperConfig& config, const GridMap& ground);

  /// The next scan, with its markers.
  void add(const Observation& observation, const Se2& map_from_base);

  /// The poses have changed: follow() has all of them to look at.
  void begin_to_follow() { unchecked_ = scans_.size(); }

  /// Draws scans anew that have moved by a cell.
  /// @param pose_of  map_from_base of a scan, by its number.
  void follow(const std::function<Se2(std::size_t)>& pose_of);

  /// Draws all of them anew at once: as where the map's frame has changed.
  void redraw(const std::function<Se2(std::size_t)>& pose_of);

  /// The same map drawn along other poses.
  GridMap drawn_along(const std::function<Se2(std::size_t)>& pose_of) const;

  const GridMap& map() const { return map_; }

  const ScanArchive& scans() const { return scans_; }

 private:
  void draw_markers(std::size_t scan, const Se2& map_from_base, GridMap& map) const;

  MapperConfig config_;
  GridMap ground_;
  GridMap map_;
  ScanArchive scans_{};
  std::vector<Se2> drawn_at_{};
  std::size_t next_{0};       ///< to be looked at, before this one; after 0 the newest
  std::size_t unchecked_{0};  ///< scans that may have moved
  bool has_moved_{false};     ///< a scan, since the markers were drawn anew
};

}  // namespace waymark
