// SPDX-License-Identifier: BSD-3-Clause
#include "slam/core/weighting/wall_score.hpp"

#include "slam/core/grid/bilinear.hpp"

namespace waymark {

WallScore wall_score(const GridMap& map, std::span<const AnnotatedBeam> beams,
                     const Se2& map_from_base) {
  const Eigen::Matrix2d turn = map_from_base.rotation();
  WallScore score;
  for (const AnnotatedBeam& annotated : beams) {
    const Eigen::Vector2d end_in_map =
        turn * annotated.beam.end_in_base + map_from_base.translation();
    visit_bilinear(map.frame, end_in_map, [&](CellIndex index, double weight) {
      const OccupancyCell& cell = map.occupancy[index];
      if (!cell.is_mapped()) return;
      score.agreement += weight * cell.occupancy();
      score.mapped += weight;
    });
  }
  return score;
}

}  // namespace waymark
