// SPDX-License-Identifier: BSD-3-Clause
#include "slam/core/localisation/map_fit.hpp"

#include "slam/core/grid/line.hpp"

#include <cstddef>

namespace waymark {
namespace {

constexpr std::size_t kMaxCompared = 120;  // beams
constexpr double kBeforeEnd_m = 0.3;  // last part of a beam, which may graze the wall that it hits

bool is_wall(const GridMap& map, CellIndex cell) {
  return map.occupancy[cell].occupancy() > kWallOccupancy;
}

bool is_beside_wall(const GridMap& map, const Eigen::Vector2d& point) {
  const CellIndex centre = map.frame.cell_of(point);
  for (int x = -1; x <= 1; ++x)
    for (int y = -1; y <= 1; ++y)
      if (is_wall(map, {centre.x + x, centre.y + y})) return true;
  return false;
}

bool is_free(const GridMap& map, const Eigen::Vector2d& point) {
  const OccupancyCell& cell = map.occupancy[map.frame.cell_of(point)];
  return cell.is_mapped() && cell.occupancy() < kFreeOccupancy;
}

/// Whether a mapped wall crosses the beam more than kBeforeEnd_m before its end `to`.
bool is_crossed(const GridMap& map, const Eigen::Vector2d& from, const Eigen::Vector2d& to) {
  const double length_m = (to - from).norm();
  if (length_m <= kBeforeEnd_m) return false;
  const Eigen::Vector2d before = to - kBeforeEnd_m / length_m * (to - from);
  bool is_crossed = false;
  visit_line(map.frame.cell_of(from), map.frame.cell_of(before),
             [&](CellIndex cell) { is_crossed |= is_wall(map, cell); });
  return is_crossed;
}

}  // namespace

MapFit fit_in_map(const GridMap& map, std::span<const AnnotatedBeam> beams,
                  const Se2& map_from_base) {
  MapFit fit;
  const std::size_t step = 1 + beams.size() / kMaxCompared;
  for (std::size_t i = 0; i < beams.size(); i += step) {
    const Beam& beam = beams[i].beam;
    const Eigen::Vector2d end = map_from_base * beam.end_in_base;
    ++fit.beams;
    if (is_crossed(map, map_from_base * beam.start_in_base, end)) {
      ++fit.contradicting;
      ++fit.crossing;
    } else if (is_beside_wall(map, end)) {
      ++fit.fitting;
    } else if (is_free(map, end)) {
      ++fit.contradicting;
    }
  }
  return fit;
}

}  // namespace waymark
