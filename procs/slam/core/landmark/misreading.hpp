// SPDX-License-Identifier: BSD-3-Clause
// Markers whose id was read wrongly.
#pragma once

#include "slam/core/landmark/marker_measurement.hpp"
#include "slam/core/mapping/landmark_map.hpp"

#include <span>

namespace waymark {

/// Two markers cannot hang in one place: a new id where a known marker of another one is still
/// being seen was misread. Where that one is missed by now it has been replaced.
/// @param known  map frame, as `map_from_base`.
bool is_misread(const MarkerMeasurement& measurement, const Se2& map_from_base,
                std::span<const Landmark> known);

}  // namespace waymark
