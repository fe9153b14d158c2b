// SPDX-License-Identifier: BSD-3-Clause
// How two maps lie to each other, by their walls.
#pragma once

#include "slam/core/graph/map_merge.hpp"

#include <optional>

namespace waymark {

/// Looks for stretches of `b` in `a`, anywhere and in any direction. A stretch counts where it fits
/// at one place only, and shows every direction there: a bare corridor never does. Two stretches
/// that are apart in `b` must agree; `shared` is how many do.
/// Seconds for maps of buildings.
std::optional<MapAlignment> align_by_walls(const MapSnapshot& a, const MapSnapshot& b);

}  // namespace waymark
