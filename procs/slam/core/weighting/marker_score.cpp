// SPDX-License-Identifier: BSD-3-Clause
#include "slam/core/weighting/marker_score.hpp"

#include "slam/core/grid/bilinear.hpp"
#include "slam/core/mapping/insert_scan.hpp"

namespace waymark {

double marker_score(const GridMap& map, const Eigen::Vector2d& point_in_map, int marker_id,
                    const MatchingRewards& rewards) {
  double votes = 0.0;
  double votes_for_markers = 0.0;
  double votes_for_id = 0.0;
  visit_bilinear(map.frame, point_in_map, [&](CellIndex index, double weight) {
    const MarkerCell& cell = map.markers[index];
    const double markers = cell.votes_for_markers();
    votes += weight * (markers + cell.none);
    votes_for_markers += weight * markers;
    if (marker_id != kNoMarker) votes_for_id += weight * cell.votes_for(marker_id);
  });
  if (votes <= 0.0) return 0.0;
  const double weight = votes / (votes + 1.0);  // of the cell; one half with a single vote
  if (marker_id == kNoMarker) return -weight * rewards.penalty * votes_for_markers / votes;
  const double match = votes_for_id / votes;
  return weight * (rewards.strong_reward * match - rewards.penalty * (1.0 - match));
}

std::vector<ObservedSpot> observed_spots(const Observation& observation, double face_spacing_m,
                                         double face_margin_m, double sighting_sigma_m) {
  std::vector<ObservedSpot> spots;
  for (const AnnotatedBeam& annotated : observation.beams) {
    if (annotated.label == BeamLabel::kOutOfView) continue;
    spots.push_back({annotated.beam.end_in_base, annotated.marker_id, 1.0});
  }
  for (const MarkerSighting& sighting : observation.sightings) {
    const double sigmas = sighting.sigma_along_wall_m() / sighting_sigma_m;
    const double weight = 1.0 / (1.0 + sigmas * sigmas);
    for (const FacePoint& point : face_points(sighting, face_spacing_m, face_margin_m))
      spots.push_back({point.in_base, point.marker_id, weight});
  }
  return spots;
}

double marker_score(const GridMap& map, std::span<const ObservedSpot> spots,
                    const Se2& map_from_base, const MatchingRewards& rewards) {
  const Eigen::Matrix2d turn = map_from_base.rotation();
  double sum = 0.0;
  for (const ObservedSpot& spot : spots) {
    const Eigen::Vector2d in_map = turn * spot.in_base + map_from_base.translation();
    sum += spot.weight * marker_score(map, in_map, spot.marker_id, rewards);
  }
  return sum;
}

}  // namespace waymark
