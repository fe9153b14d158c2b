// SPDX-License-Identifier: BSD-3-Clause
// Data preprocessing of the paper (IV-A): a marker id for each LiDAR beam.
#pragma once

#include "slam/core/scan/beams.hpp"
#include "slam/core/scan/camera_view.hpp"
#include "slam/core/scan/marker_sighting.hpp"

#include <span>
#include <vector>

namespace waymark {

/// What the camera says about the spot where a beam ended.
enum class Sight {
  kUnknown,  ///< outside of the camera's view
  kNone,     ///< no marker there
  kMarker,   ///< a marker: its id is given
};

struct AnnotatedBeam {
  Beam beam{};
  Sight sight{Sight::kUnknown};
  int marker_id{kNoMarker};
};

/// Gives each beam the id of the nearest sighted marker whose segment it ends within `tolerance_m`
/// of; the others have seen no marker if `view` (null = no camera frame) shows that spot.
std::vector<AnnotatedBeam> annotate(std::span<const Beam> beams,
                                    std::span<const MarkerSighting> sightings,
                                    const CameraView* view, double tolerance_m);

}  // namespace waymark
