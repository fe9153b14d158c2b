// SPDX-License-Identifier: BSD-3-Clause
#include "slam/core/estimators/estimate.hpp"

#include <algorithm>

namespace waymark {

Health health_of(std::uint64_t updates, bool is_lost, bool observes_all_axes) {
  if (updates < 2) return Health::kInitialising;
  if (is_lost) return Health::kLost;
  return observes_all_axes ? Health::kTracking : Health::kDegenerate;
}

Estimate describe_observation(const Observation& observation, const Se2& map_from_base,
                              double range_sigma_m) {
  Estimate estimate;
  estimate.time = observation.time;
  estimate.map_from_base = map_from_base;
  estimate.beams_on_markers = static_cast<int>(
      std::count_if(observation.beams.begin(), observation.beams.end(),
                    [](const AnnotatedBeam& beam) { return beam.marker_id != kNoMarker; }));
  estimate.markers_in_view = static_cast<int>(observation.sightings.size());
  estimate.observability = observability_of(observation.beams, map_from_base, range_sigma_m);
  return estimate;
}

}  // namespace waymark
