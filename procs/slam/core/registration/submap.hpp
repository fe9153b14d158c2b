// SPDX-License-Identifier: BSD-3-Clause
// A few metres of scans in the frame of a keyframe.
#pragma once

#include "slam/core/motion/pose_sequence.hpp"
#include "slam/core/registration/coarse_ndt.hpp"
#include "slam/core/registration/scan_match.hpp"

#include <cstddef>
#include <span>
#include <unordered_set>
#include <vector>

namespace waymark {

class Submap {
 public:
  /// The submap's frame is the base frame of the first keyframe.
  Submap(double cell_spacing_m, std::size_t first_keyframe)
      : spacing_m_{cell_spacing_m},
        first_keyframe_{first_keyframe},
        ndt_{cell_spacing_m, NdtMap::Cells::kDivided},
        coarse_{cell_spacing_m} {}

  /// Inserts the next keyframe; there must be no gap.
  void insert(const Points& points_in_base, const Se2& submap_from_base);

  /// Inserts a scan between keyframes, attributed to the newest keyframe.
  void add(const Points& points_in_base, const Se2& submap_from_base);

  /// Whether the keyframes' relative poses have changed since they were inserted.
  bool is_deformed(const PoseSequence& keyframes) const;

  /// From now on is_deformed() is false: the scans stay where they were inserted.
  void freeze_shape() { is_shape_frozen_ = true; }

  /// A submap of the same scans, inserted at the present poses of their keyframes. Precondition:
  /// not finished.
  Submap rebuilt(const PoseSequence& keyframes) const;

  std::size_t first_keyframe() const { return first_keyframe_; }

  /// For the first keyframe's present pose.
  Se2 submap_from_map(const PoseSequence& keyframes) const {
    return keyframes[first_keyframe_].inverse();
  }

  std::size_t last_keyframe() const { return first_keyframe_ + poses_.size() - 1; }

  std::size_t num_keyframes() const { return poses_.size(); }

  const NdtMap& ndt() const { return ndt_; }

  std::span<const NdtMap> coarse_ndt() const { return coarse_.levels(); }

  /// One point for each occupied cell of 5 cm, submap frame.
  const Points& points() const { return points_; }

  /// To be called after the last insertion: frees memory.
  /// @param point_variance_m2  as in later uses of ndt().
  void finish(double point_variance_m2);

  /// Largest distance of a keyframe from the first one.
  double radius_m() const { return radius_m_; }

  /// Length of the path from the first keyframe to the last.
  double path_length_m() const { return path_length_m_; }

  /// The pose at which a keyframe was inserted.
  const Se2& submap_from_keyframe(std::size_t keyframe) const {
    return poses_[keyframe - first_keyframe_];
  }

 private:
  /// A scan that was inserted.
  struct Scan {
    Points points_in_base{};
    std::size_t keyframe{0};
    Se2 keyframe_from_base{};
  };

  static constexpr double kThinned_m = 0.05;

  void draw(const Points& points_in_base, const Se2& submap_from_base);

  double spacing_m_;
  std::size_t first_keyframe_;
  NdtMap ndt_;
  CoarseNdt coarse_;
  std::vector<Se2> poses_{};
  double radius_m_{0.0};
  double path_length_m_{0.0};
  bool is_shape_frozen_{false};
  std::vector<Scan> scans_{};                   ///< until the submap is finished
  std::unordered_set<NdtMap::Key> occupied_{};  ///< cells of kThinned_m; never iterated over
  Points points_{};
};

}  // namespace waymark
