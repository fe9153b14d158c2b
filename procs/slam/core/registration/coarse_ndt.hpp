// SPDX-License-Identifier: BSD-3-Clause
// NDT maps with larger cells, for matches with a poor initial guess.
#pragma once

#include "slam/core/registration/ndt_map.hpp"

#include <Eigen/Core>

#include <array>
#include <span>

namespace waymark {

/// Each level's cells are twice as large as those of the previous level (multi-layered NDT; Ulas
/// and Temeltas 2013). Large cells also collect enough points where these are sparse, on distant
/// walls.
class CoarseNdt {
 public:
  /// @param finest_spacing_m  cell spacing of the NDT map that these levels complement.
  explicit CoarseNdt(double finest_spacing_m)
      : levels_{NdtMap{2.0 * finest_spacing_m}, NdtMap{4.0 * finest_spacing_m}} {}

  void add(const Eigen::Vector2d& point) {
    for (NdtMap& level : levels_)
      level.add(point, kNoKeyframe);
  }

  /// The finest first.
  std::span<const NdtMap> levels() const { return levels_; }

 private:
  std::array<NdtMap, 2> levels_;
};

}  // namespace waymark
