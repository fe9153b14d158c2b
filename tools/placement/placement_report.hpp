// SPDX-License-Identifier: BSD-3-Clause
// Formats a placement as text, JSON, CSV and picture.
#pragma once

#include "placement/placement.hpp"

#include <string>

namespace waymark::placement {

/// Sigmas now, stretches above the target, new markers, and what limits the result.
std::string placement_text(const PlacementInput& input, const Placement& placement);

/// The same as one JSON object; lengths in metres, angles in radians, map frame.
std::string placement_json(const PlacementInput& input, const Placement& placement);

/// The new markers with the columns of markers.csv; sigmas and sightings are 0.
std::string placement_csv(const Placement& placement);

/// The map as the viewer draws it, with circles around the new markers. Bytes of a PNG file.
std::string placement_picture(const PlacementInput& input, const Placement& placement);

}  // namespace waymark::placement
