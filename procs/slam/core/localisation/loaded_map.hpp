// SPDX-License-Identifier: BSD-3-Clause
// The map that a run localises in or extends.
#pragma once

#include "slam/core/association/marker_book.hpp"
#include "slam/core/localisation/loaded_map_fit.hpp"
#include "slam/core/localisation/map_snapshot.hpp"
#include "slam/core/localisation/wall_change_detector.hpp"
#include "slam/core/registration/coarse_ndt.hpp"
#include "slam/core/registration/points.hpp"
#include "slam/core/registration/scan_match.hpp"
#include "slam/core/scan/observation.hpp"

#include <cstdint>
#include <memory>
#include <vector>

namespace waymark {

/// What the pose in a loaded map rests on. Walls of another place may fit, too.
enum class PlaceTrust {
  kAssumed,    ///< only a start pose or a command
  kFitsWalls,  ///< a scan that observes every direction
  kKnown,      ///< markers, the place finder, or a start pose that is certain
};

/// A loaded map never changes. This class matches scans with its walls, and judges by what is seen
/// whether the pose in it is right and whether it is a map of this building.
class LoadedMap {
 public:
  explicit LoadedMap(std::shared_ptr<const MapSnapshot> map);

  const MapSnapshot& snapshot() const { return *map_; }

  /// Centres of the wall cells; map frame.
  const Points& wall_points() const { return wall_points_; }

  Points wall_points_near(const Eigen::Vector2d& place, double within_m) const;

  /// match_scan() with the map's walls.
  ScanMatch match(const Points& points_in_base, const Se2& guess,
                  const Eigen::Matrix3d& guess_covariance, const RangeNoise& noise,
                  const ScanMatchConfig& config) const;

  void trust(PlaceTrust place_trust);

  /// To be called when a command has given the pose: what was seen before says nothing about it.
  void forget_votes() { votes_ = {}; }

  bool is_confirmed() const { return place_trust_ != PlaceTrust::kAssumed; }

  /// Whether is_confirmed() was true at least once.
  bool was_confirmed() const { return was_confirmed_; }

  /// Compares a keyframe's scan, at its estimated pose, with the map.
  /// @param fits_walls  the scan's match with this map observes every direction. This confirms the
  ///                    pose, unless too many beams cross walls: at a wrong heading, the walls that
  ///                    are in the map may fit all the same.
  void compare(const Observation& observation, const Se2& map_from_base, bool fits_walls,
               const MarkerBook::KnownMarkers& markers);

  const LoadedMapFit& fit() const { return fit_; }

  /// Whether most scans contradict the pose in the map, and it is not known otherwise.
  bool is_pose_refuted() const;

  /// Whether most of what was seen contradicts the map, although some of its markers are where it
  /// has them: another building may have the same ids, at some of the same places.
  bool is_of_another_building() const {
    return fit_.do_markers_contradict() || fit_.do_walls_contradict();
  }

  /// Adds a scan whose pose is reliable to the search for walls that have changed.
  void add_scan(const Observation& observation, const Se2& map_from_base) {
    wall_changes_.add(observation, map_from_base);
  }

  std::vector<MapChange> wall_changes() const { return wall_changes_.changes(); }

 private:
  /// Numbers of recent scans that were compared, none from before a command.
  struct Votes {
    std::int64_t decisive{0};  ///< scans with enough beams in mapped cells (MapFit)
    std::int64_t refuting{0};  ///< of these, with too many beams through walls
  };

  std::shared_ptr<const MapSnapshot> map_;
  Points wall_points_;
  CoarseNdt coarse_;
  WallChangeDetector wall_changes_;
  PlaceTrust place_trust_{PlaceTrust::kAssumed};
  bool was_confirmed_{false};
  Votes votes_{};
  LoadedMapFit fit_{};
};

}  // namespace waymark
