// SPDX-License-Identifier: BSD-3-Clause
// Markers that differ from a loaded map: moved, new or missing.
#pragma once

#include "slam/core/association/marker_book.hpp"
#include "slam/core/localisation/map_snapshot.hpp"
#include "slam/core/mapping/map_change.hpp"

#include <vector>

namespace waymark {

/// @param book   its first entries are the map's landmarks, in the map's order.
/// @param state  poses of the book's landmarks.
std::vector<MapChange> marker_changes(const MapSnapshot& map, const MarkerBook& book,
                                      const State& state);

}  // namespace waymark
