// SPDX-License-Identifier: BSD-3-Clause
// Aligns two maps by their walls.
#pragma once

#include "map/map_merge.hpp"

#include <optional>

namespace waymark {

/// Searches `a` for stretches of walls of `b` (4 m around poses of its trajectory), anywhere and in
/// any direction. A stretch counts if it fits at one place only and the match there is not
/// degenerate (in a bare corridor it always is). `shared` is the number of consistent stretches;
/// nullopt if it is below two. Takes seconds for maps of buildings.
std::optional<MapAlignment> align_by_walls(const MapSnapshot& a, const MapSnapshot& b);

}  // namespace waymark
