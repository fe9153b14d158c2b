// SPDX-License-Identifier: BSD-3-Clause
// A few metres of scans in the frame of a keyframe.
#pragma once

#include "slam/core/registration/coarse_ndt.hpp"
#include "slam/core/registration/scan_match.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <unordered_set>
#include <vector>

namespace waymark {

class Submap {
 public:
  /// The submap's frame is the base frame of the first keyframe.
  Submap(double cell_spacing_m, std::size_t first_keyframe)
      : first_keyframe_{first_keyframe}, ndt_{cell_spacing_m}, coarse_{cell_spacing_m} {}

  /// Inserts the next keyframe; there must be no gap.
  void insert(const Points& points_in_base, const Se2& submap_from_base) {
    if (!poses_.empty())
      length_m_ += (submap_from_base.translation() - poses_.back().translation()).norm();
    poses_.push_back(submap_from_base);
    reach_m_ = std::max(reach_m_, submap_from_base.translation().norm());
    add(points_in_base, submap_from_base);
  }

  /// Inserts a scan between keyframes, attributed to the newest keyframe.
  void add(const Points& points_in_base, const Se2& submap_from_base) {
    const auto keyframe = static_cast<int>(last_keyframe());
    for (const Eigen::Vector2d& point : points_in_base) {
      const Eigen::Vector2d there = submap_from_base * point;
      ndt_.add(there, keyframe);
      const auto column = static_cast<int>(std::lround(there.x() / kThinned_m));
      const auto row = static_cast<int>(std::lround(there.y() / kThinned_m));
      if (!occupied_.insert(NdtMap::key(column, row)).second) continue;
      points_.push_back(there);
      coarse_.add(there);
    }
  }

  std::size_t first_keyframe() const { return first_keyframe_; }

  std::size_t last_keyframe() const { return first_keyframe_ + poses_.size() - 1; }

  std::size_t num_keyframes() const { return poses_.size(); }

  const NdtMap& ndt() const { return ndt_; }

  std::span<const NdtMap> coarse_ndt() const { return coarse_.levels(); }

  /// One point for each occupied cell of 5 cm, submap frame.
  const Points& points() const { return points_; }

  /// To be called after the last insertion: frees memory.
  void finish() { occupied_.clear(); }

  /// Largest distance of a keyframe from the first one.
  double reach_m() const { return reach_m_; }

  /// Length of the path from the first keyframe to the last.
  double length_m() const { return length_m_; }

  /// The pose at which a keyframe was inserted.
  const Se2& submap_from_keyframe(std::size_t keyframe) const {
    return poses_[keyframe - first_keyframe_];
  }

 private:
  static constexpr double kThinned_m = 0.05;

  std::size_t first_keyframe_;
  NdtMap ndt_;
  CoarseNdt coarse_;
  std::vector<Se2> poses_{};
  double reach_m_{0.0};
  double length_m_{0.0};
  std::unordered_set<NdtMap::Key> occupied_{};  ///< cells of kThinned_m; never iterated over
  Points points_{};
};

}  // namespace waymark
