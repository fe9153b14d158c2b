// SPDX-License-Identifier: BSD-3-Clause
// The submaps of a run.
#pragma once

#include "slam/core/motion/pose_sequence.hpp"
#include "slam/core/registration/submap.hpp"

#include <algorithm>
#include <cstddef>
#include <deque>
#include <functional>

namespace waymark {

/// Two submaps are filled at a time, one half a submap's length behind the other. Scans are matched
/// with the older one, which is at least half full except at the start, and is finished when full.
class Submaps {
 public:
  /// @param keyframes_each  largest number of keyframes in a submap.
  /// @param length_m        length of the path after which a submap ends, since drift deforms it:
  ///                        each half ends at the keyframe that reaches half of it.
  Submaps(double cell_spacing_m, int keyframes_each, double length_m)
      : cell_spacing_m_{cell_spacing_m},
        half_keyframes_{static_cast<std::size_t>(std::max(1, keyframes_each / 2))},
        half_m_{0.5 * length_m} {}

  /// The submap that new scans are matched with; null: none has begun.
  const Submap* current() const { return growing_.empty() ? nullptr : &growing_.front(); }

  const std::deque<Submap>& finished() const { return finished_; }

  /// The finished submap with this first keyframe; null: it was dropped.
  const Submap* find(std::size_t first_keyframe) const;

  /// Adds the scan of the newest keyframe.
  /// @param point_variance_m2  of ranges, as learnt so far.
  void add_keyframe(const Points& points_in_base, const PoseSequence& keyframes,
                    double point_variance_m2);

  /// Adds a scan between keyframes, attributed to the newest keyframe.
  void add_between(const Points& points_in_base, const Se2& map_from_base,
                   const PoseSequence& keyframes);

  /// Rebuilds unfinished submaps whose keyframes have moved relative to each other. Otherwise,
  /// after a loop closure has moved the newest keyframes, the next scans would be matched with
  /// walls at the old poses.
  void rebuild_deformed(const PoseSequence& keyframes);

  /// From now on unfinished submaps are not rebuilt. To be called when keyframes have lost their
  /// odometry: where walls do not observe the motion, hardly anything holds these keyframes
  /// together any more.
  void freeze_shapes() {
    for (Submap& submap : growing_)
      submap.freeze_shape();
  }

  /// Drops unfinished submaps, after the robot was relocated.
  void begin_anew() { growing_.clear(); }

  /// Drops finished submaps that contain removed keyframes.
  void forget(const std::function<bool(std::size_t)>& is_removed);

 private:
  double cell_spacing_m_;
  std::size_t half_keyframes_;  ///< half of the largest number of keyframes in a submap
  double half_m_;               ///< half of the largest length of a submap
  std::deque<Submap> finished_{};
  std::deque<Submap> growing_{};  ///< at most two, the older one first
};

}  // namespace waymark
