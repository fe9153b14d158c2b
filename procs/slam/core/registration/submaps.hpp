// SPDX-License-Identifier: BSD-3-Clause
// The submaps of a drive.
#pragma once

#include "slam/core/motion/pose_sequence.hpp"
#include "slam/core/registration/submap.hpp"

#include <algorithm>
#include <cstddef>
#include <deque>
#include <functional>

namespace waymark {

/// Two submaps are filled at a time, one half a length behind the other: the older one is matched,
/// and holds half a length of scans at least. When it is full it is finished.
class Submaps {
 public:
  /// @param keyframes_each  of a submap, at most.
  /// @param length_m        driven along a submap, at most: drift bends longer ones.
  Submaps(double cell_spacing_m, int keyframes_each, double length_m)
      : cell_spacing_m_{cell_spacing_m},
        half_{static_cast<std::size_t>(std::max(1, keyframes_each / 2))},
        half_m_{0.5 * length_m} {}

  /// The one to match scans with; null: none has begun.
  const Submap* matched() const { return growing_.empty() ? nullptr : &growing_.front(); }

  const std::deque<Submap>& finished() const { return finished_; }

  /// A finished one, by its first keyframe; null: it was dropped.
  const Submap* find(std::size_t first_keyframe) const;

  /// The newest keyframe's scan.
  void add_keyframe(const Points& points_in_base, const PoseSequence& keyframes);

  /// A scan between keyframes; it counts for the newest keyframe.
  void add_between(const Points& points_in_base, const Se2& map_from_base,
                   const PoseSequence& keyframes);

  /// Drops unfinished submaps, after the robot was relocated.
  void begin_anew() { growing_.clear(); }

  /// Drops finished submaps that have removed keyframes.
  void forget(const std::function<bool(std::size_t)>& is_removed);

 private:
  double cell_spacing_m_;
  std::size_t half_;  ///< of the keyframes of one
  double half_m_;     ///< of its length
  std::deque<Submap> finished_{};
  std::deque<Submap> growing_{};  ///< one or two
};

}  // namespace waymark
