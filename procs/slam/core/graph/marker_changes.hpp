// SPDX-License-Identifier: BSD-3-Clause
// Markers that do not hang where a loaded map has them.
#pragma once

#include "slam/core/graph/association.hpp"
#include "slam/core/graph/map_snapshot.hpp"
#include "slam/core/mapping/map_change.hpp"

#include <vector>

namespace waymark {

/// @param book   its first entries are the map's.
/// @param state  poses of the book's landmarks.
std::vector<MapChange> marker_changes(const MapSnapshot& map, const MarkerBook& book,
                                      const State& state);

}  // namespace waymark
