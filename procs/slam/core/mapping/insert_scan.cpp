// SPDX-License-Identifier: BSD-3-Clause
#include "slam/core/mapping/insert_scan.hpp"

#include "slam/core/grid/line.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

namespace waymark {

namespace {

/// @param count  1 to insert the beams, -1 (modulo 2^32) to erase them.
void count_beams(std::span<const AnnotatedBeam> beams, const Se2& map_from_base,
                 std::uint32_t count, GridMap& map) {
  const Eigen::Matrix2d rotation = map_from_base.rotation();
  const auto cell_of = [&](const Eigen::Vector2d& in_base) {
    return map.frame.cell_of(rotation * in_base + map_from_base.translation());
  };
  std::vector<CellIndex> hit;
  hit.reserve(beams.size());
  for (const AnnotatedBeam& annotated : beams) {
    hit.push_back(cell_of(annotated.beam.end_in_base));
    OccupancyCell& cell = map.occupancy.edit(hit.back());
    cell.hits += count;
    cell.visits += count;
  }
  // Where a beam of the scan ends, the others do not pass: such cells keep their visits.
  std::vector<std::uint32_t> visits;
  visits.reserve(beams.size());
  for (const CellIndex& cell : hit)
    visits.push_back(map.occupancy[cell].visits);
  TileEditor editor{map.occupancy};
  for (std::size_t i = 0; i < beams.size(); ++i)
    visit_line(cell_of(beams[i].beam.start_in_base), hit[i],
               [&](CellIndex cell) { editor.edit(cell).visits += count; });
  for (std::size_t i = 0; i < beams.size(); ++i)
    map.occupancy.edit(hit[i]).visits = visits[i];
}

}  // namespace

void insert_beams(std::span<const AnnotatedBeam> beams, const Se2& map_from_base, GridMap& map) {
  count_beams(beams, map_from_base, 1, map);
}

void erase_beams(std::span<const AnnotatedBeam> beams, const Se2& map_from_base, GridMap& map) {
  count_beams(beams, map_from_base, ~std::uint32_t{0}, map);
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
