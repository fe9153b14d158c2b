// SPDX-License-Identifier: BSD-3-Clause
#include "slam/core/weighting/marker_score.hpp"

#include "slam/core/grid/bilinear.hpp"

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
  const double trust = votes / (votes + 1.0);  // one look is half of what can be known
  if (marker_id == kNoMarker) return -trust * rewards.penalty * votes_for_markers / votes;
  const double match = votes_for_id / votes;
  return trust * (rewards.strong_reward * match - rewards.penalty * (1.0 - match));
}

double marker_score(const GridMap& map, std::span<const JudgedSpot> spots, const Se2& map_from_base,
                    const MatchingRewards& rewards) {
  const Eigen::Matrix2d turn = map_from_base.rotation();
  double sum = 0.0;
  for (const JudgedSpot& spot : spots) {
    const Eigen::Vector2d in_map = turn * spot.in_base + map_from_base.translation();
    sum += spot.trust * marker_score(map, in_map, spot.marker_id, rewards);
  }
  return sum;
}

}  // namespace waymark
