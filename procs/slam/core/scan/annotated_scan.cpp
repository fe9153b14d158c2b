// SPDX-License-Identifier: BSD-3-Clause
#include "slam/core/scan/annotated_scan.hpp"

#include <algorithm>

namespace waymark {
namespace {

double distance_to_segment_m(const Eigen::Vector2d& point, const MarkerSighting& sighting) {
  const Eigen::Vector2d centre = sighting.base_from_marker.translation();
  const double half_m = 0.5 * sighting.size_m;
  const Eigen::Vector2d right = sighting.point_at(1.0) - centre;
  const double right_m = std::clamp(right.dot(point - centre), -half_m, half_m);
  return (point - sighting.point_at(right_m)).norm();
}

}  // namespace

std::vector<AnnotatedBeam> annotate(std::span<const Beam> beams,
                                    std::span<const MarkerSighting> sightings,
                                    const CameraView* view, double tolerance_m) {
  std::vector<AnnotatedBeam> annotated;
  annotated.reserve(beams.size());
  for (const Beam& beam : beams) {
    AnnotatedBeam result{beam};
    double nearest_m = tolerance_m;
    for (const MarkerSighting& sighting : sightings) {
      const double distance_m = distance_to_segment_m(beam.end_in_base, sighting);
      if (distance_m > nearest_m) continue;
      nearest_m = distance_m;
      result.label = BeamLabel::kMarker;
      result.marker_id = sighting.id;
    }
    if (result.label != BeamLabel::kMarker && view && view->would_show(beam.end_in_base)) {
      result.label = BeamLabel::kUnmarked;
    }
    annotated.push_back(result);
  }
  return annotated;
}

}  // namespace waymark
