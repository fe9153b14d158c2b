// SPDX-License-Identifier: BSD-3-Clause
// Transforms maps into other frames, and merges two maps.
#pragma once

#include "slam/core/localisation/map_snapshot.hpp"

#include <cstddef>
#include <optional>

namespace waymark {

/// The same map in another frame. Poses, markers and their covariances are exact; grid cells are
/// sampled at their centres; NDT cells (walls) are re-sampled with their mean and covariance.
MapSnapshot transformed(const MapSnapshot& map, const Se2& new_from_old);

/// Relative pose of two maps.
struct MapAlignment {
  Se2 a_from_b{};
  std::size_t shared{0};  ///< inliers: markers, or stretches of walls
  double rms_m{0.0};      ///< root mean square of the inliers' distances
};

/// Aligns by the markers whose id is unique in both maps, using the largest set that agrees within
/// its covariances (see SharedMarker), so that a few moved markers do not matter; agreement_of()
/// says which those are. nullopt if no two consistent markers are a metre apart.
std::optional<MapAlignment> align_by_markers(const MapSnapshot& a, const MapSnapshot& b);

/// Both maps as one, in the frame of `a`. Markers in both are averaged by their information; of one
/// that was moved a little in between, the place where it was seen last counts.
MapSnapshot merged(const MapSnapshot& a, const MapSnapshot& b, const Se2& a_from_b);

}  // namespace waymark
