// SPDX-License-Identifier: BSD-3-Clause
// A placement for people and for programs.
#pragma once

#include "placement/placement.hpp"

#include <string>

namespace waymark::placement {

/// What the run shows, the stretches above the target, the places, and what cannot be cured.
std::string placement_text(const PlacementInput& input, const Placement& placement);

/// The same as one JSON object; lengths in metres, angles in radians, map frame.
std::string placement_json(const PlacementInput& input, const Placement& placement);

/// The new markers in the columns of markers.csv; their sigmas are 0, they have no sightings.
std::string placement_csv(const Placement& placement);

/// The map as the viewer draws it, with the new places ringed. Bytes of a PNG file.
std::string placement_picture(const PlacementInput& input, const Placement& placement);

}  // namespace waymark::placement
