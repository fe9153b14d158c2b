// SPDX-License-Identifier: BSD-3-Clause
#include "slam/core/localisation/map_snapshot.hpp"

#include "slam/core/mapping/seen_through.hpp"

#include <algorithm>

namespace waymark {
namespace {

constexpr double kMaxPoints = 400.0;  // per cell, so that later points can outweigh them

}  // namespace

NdtMap walls_to_save(const NdtMap& walls, const GridMap& grid, double point_variance_m2) {
  NdtMap kept{walls.spacing_m()};
  for (NdtCellSums cell : walls.sums()) {
    const Eigen::Vector2d centre = kept.spacing_m() * Eigen::Vector2d{cell.column, cell.row};
    const NdtCell* shape = walls.at(centre, point_variance_m2);
    // The mean of two walls that meet at a corner lies in free space.
    const bool has_free_middle = shape != nullptr && !shape->is_line;
    if (has_free_middle ? is_seen_through(grid, centre, kept.spacing_m())
                        : is_seen_through(grid, centre + cell.sum_m / cell.count)) {
      continue;
    }
    const double share = std::min(1.0, kMaxPoints / cell.count);
    cell.count *= share;
    cell.sum_m *= share;
    cell.squares_m2 *= share;
    kept.add(cell);
  }
  return kept;
}

Eigen::Matrix3d covariance_at(const MapSnapshot& map, const Eigen::Vector2d& place) {
  const Landmark* nearest = nullptr;
  const auto away = [&place](const Landmark& landmark) {
    return (landmark.map_from_marker.translation() - place).norm();
  };
  for (const Landmark& landmark : map.landmarks)
    if (nearest == nullptr || away(landmark) < away(*nearest)) nearest = &landmark;
  return nearest == nullptr ? Eigen::Matrix3d::Zero() : nearest->covariance;
}

}  // namespace waymark
