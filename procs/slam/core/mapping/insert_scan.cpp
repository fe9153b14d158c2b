// SPDX-License-Identifier: BSD-3-Clause
#include "slam/core/mapping/insert_scan.hpp"

#include "slam/core/grid/line.hpp"

#include <algorithm>

namespace waymark {

void insert_beams(std::span<const AnnotatedBeam> beams, const Se2& map_from_base, GridMap& map) {
  std::vector<CellIndex> hit;
  hit.reserve(beams.size());
  for (const AnnotatedBeam& annotated : beams) {
    hit.push_back(map.frame.cell_of(map_from_base * annotated.beam.end_in_base));
    OccupancyCell& cell = map.occupancy.edit(hit.back());
    ++cell.hits;
    ++cell.visits;
  }
  std::vector<CellIndex> sorted_hit = hit;
  std::sort(sorted_hit.begin(), sorted_hit.end());
  for (std::size_t i = 0; i < beams.size(); ++i) {
    const CellIndex start = map.frame.cell_of(map_from_base * beams[i].beam.start_in_base);
    visit_line(start, hit[i], [&](CellIndex cell) {
      if (!std::binary_search(sorted_hit.begin(), sorted_hit.end(), cell)) {
        ++map.occupancy.edit(cell).visits;
      }
    });
  }
}

std::vector<FacePoint> face_points(const MarkerSighting& sighting, double spacing_m,
                                   double margin_m) {
  const double half_m = 0.5 * sighting.size_m;
  const double reach_m = half_m + margin_m;
  // Symmetric about the centre, so that a mirrored marker has mirrored points.
  const int count = std::max(1, static_cast<int>(std::lround(2.0 * reach_m / spacing_m)));
  std::vector<FacePoint> points;
  points.reserve(static_cast<std::size_t>(count));
  for (int i = 0; i < count; ++i) {
    const double right_m = (i - 0.5 * (count - 1)) * spacing_m;
    points.push_back(
        {sighting.point_at(right_m), std::abs(right_m) < half_m ? sighting.id : kNoMarker});
  }
  return points;
}

void insert_face_points(std::span<const FacePoint> points, double spacing_m,
                        const Se2& map_from_base, GridMap& map) {
  const auto vote = static_cast<float>(spacing_m / map.frame.resolution_m);
  for (const FacePoint& point : points) {
    map.markers.edit(map.frame.cell_of(map_from_base * point.in_base)).vote(point.marker_id, vote);
  }
}

}  // namespace waymark
