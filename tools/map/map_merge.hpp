// SPDX-License-Identifier: BSD-3-Clause
// Transforms maps into other frames, and merges two maps.
#pragma once

#include "slam/core/graph/map_snapshot.hpp"

#include <cstddef>
#include <optional>

namespace waymark {

/// The same map in another frame: poses, markers and their covariances exactly; cells of the grid
/// are sampled at their centres, walls keep mean and covariance of every half metre.
MapSnapshot transformed(const MapSnapshot& map, const Se2& new_from_old);

/// The rigid motion between two maps.
struct MapAlignment {
  Se2 a_from_b{};
  std::size_t shared{0};  ///< inliers: markers, or stretches of walls
  double rms_m{0.0};      ///< of the inliers' distances
};

/// By markers that are the only ones of their id in both maps. The largest consistent set is used,
/// so that some moved markers do no harm. Nothing if fewer than two of them are consistent that are
/// a metre apart.
std::optional<MapAlignment> align_by_markers(const MapSnapshot& a, const MapSnapshot& b);

/// Both maps in the frame of `a`. Markers in both are the mean by their information.
MapSnapshot merged(const MapSnapshot& a, const MapSnapshot& b, const Se2& a_from_b);

}  // namespace waymark
