// SPDX-License-Identifier: BSD-3-Clause
// Whether two maps show the same building once one is laid over the other.
#pragma once

#include "slam/core/localisation/map_snapshot.hpp"

#include <Eigen/Core>

#include <cstddef>
#include <string>
#include <vector>

namespace waymark {

/// A marker whose id is unique in both maps, with its place and covariance in each.
struct SharedMarker {
  int id{kNoMarker};
  Eigen::Vector2d in_a{Eigen::Vector2d::Zero()};
  Eigen::Vector2d in_b{Eigen::Vector2d::Zero()};
  Eigen::Matrix2d covariance_a{Eigen::Matrix2d::Zero()};
  Eigen::Matrix2d covariance_b{Eigen::Matrix2d::Zero()};

  double apart_m(const Se2& a_from_b) const;

  /// Whether both maps may show it at one place: within their covariances and the drift that these
  /// leave out, but never beyond what a rigid merge would draw as two walls.
  bool agrees(const Se2& a_from_b) const;
};

/// The confirmed markers whose id each map has once; in the order of a's landmarks.
std::vector<SharedMarker> shared_markers(const MapSnapshot& a, const MapSnapshot& b);

/// The walls of one map laid over another. Cells where the other map knows nothing do not count.
struct WallAgreement {
  std::size_t agreeing{0};       ///< wall cells on a wall of the other map
  std::size_t contradicting{0};  ///< wall cells in its free space

  /// 0 to 1; 0 where too few cells overlap to say.
  double contradicting_share() const;
};

/// Compares the walls of b with a. O(wall cells of b).
WallAgreement walls_in(const GridMap& a, const GridMap& b, const Se2& a_from_b);

/// Everything that two maps have in common, laid over each other.
struct MapAgreement {
  std::size_t shared{0};                  ///< markers
  std::vector<SharedMarker> disagreeing;  ///< of these
  double contradicting_walls{0.0};        ///< share, of the map whose walls fit worse
  Se2 a_from_b{};

  std::size_t agreeing() const { return shared - disagreeing.size(); }

  /// What speaks against one building, in words; empty if nothing does.
  std::string objection() const;

  /// "10 of 12 shared markers agree; not 3 (0.52 m apart), 7 (1.03 m apart)"
  std::string markers_text() const;
};

MapAgreement agreement_of(const MapSnapshot& a, const MapSnapshot& b, const Se2& a_from_b);

}  // namespace waymark
