// SPDX-License-Identifier: BSD-3-Clause
// Data preprocessing of the paper (IV-A): a marker id for each LiDAR beam.
#pragma once

#include "slam/core/scan/beams.hpp"
#include "slam/core/scan/camera_view.hpp"
#include "slam/core/scan/marker_sighting.hpp"

#include <span>
#include <vector>

namespace waymark {

/// The camera's observation of the point where a beam ended.
enum class BeamLabel {
  kOutOfView,  ///< the camera does not see the point, or there is no camera frame
  kUnmarked,   ///< no marker is there
  kMarker,     ///< a marker is there, see marker_id
};

struct AnnotatedBeam {
  Beam beam{};
  BeamLabel label{BeamLabel::kOutOfView};
  int marker_id{kNoMarker};
};

/// Labels each beam that ends within `tolerance_m` of a sighted marker's segment with the id of the
/// nearest one; the others with kUnmarked if their end is in `view` (null: no camera frame).
std::vector<AnnotatedBeam> annotate(std::span<const Beam> beams,
                                    std::span<const MarkerSighting> sightings,
                                    const CameraView* view, double tolerance_m);

}  // namespace waymark
