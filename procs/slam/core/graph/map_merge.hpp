// SPDX-License-Identifier: BSD-3-Clause
// Maps in other frames, and two maps as one.
#pragma once

#include "slam/core/graph/map_snapshot.hpp"

#include <cstddef>
#include <optional>

namespace waymark {

/// The same map in another frame: poses, markers and their covariances exactly; cells of the grid
/// are sampled at their centres, walls keep mean and covariance of every half metre.
MapSnapshot transformed(const MapSnapshot& map, const Se2& new_from_old);

/// How two maps lie to each other.
struct MapAlignment {
  Se2 a_from_b{};
  std::size_t shared{0};  ///< markers, or stretches of walls, that agree
  double rms_m{0.0};      ///< of their positions
};

/// By markers that are the only ones of their id in both maps. The largest set that agrees counts,
/// so that some that were moved do no harm. Nothing if fewer than two agree that are a metre apart.
std::optional<MapAlignment> align_by_markers(const MapSnapshot& a, const MapSnapshot& b);

/// Both maps in the frame of `a`. Markers in both are the mean by their information.
MapSnapshot merged(const MapSnapshot& a, const MapSnapshot& b, const Se2& a_from_b);

}  // namespace waymark
