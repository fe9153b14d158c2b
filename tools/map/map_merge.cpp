// SPDX-License-Identifier: BSD-3-Clause
#include "map/map_merge.hpp"

#include "common/geometry/rigid_fit.hpp"
#include "map/map_agreement.hpp"

#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <set>
#include <utility>

namespace waymark {
namespace {

constexpr int kRefinements = 5;        // of the set of markers that agree; it changes by one or two
constexpr double kMinApart_m = 1.0;    // distance of two markers that determine the rotation
constexpr int kSamplesAlong = 6;       // sample points along an NDT cell's major axis
constexpr double kSameMarker_m = 0.5;  // landmarks of one id closer than this are one marker

/// Each new cell takes the contents of the old cell at its centre.
GridMap transformed(const GridMap& grid, const Se2& new_from_old) {
  GridMap result;
  result.frame = grid.frame;
  const Se2 old_from_new = new_from_old.inverse();
  std::set<TileIndex> tiles;  // of the new grid that old cells fall into
  const auto note = [&](TileIndex index, const auto&) {
    for (std::size_t offset = 0; offset < kTileCells; ++offset)
      tiles.insert(
          tile_of(grid.frame.cell_of(new_from_old * grid.frame.centre_of(cell_at(index, offset)))));
  };
  grid.occupancy.for_each_tile(note);
  grid.markers.for_each_tile(note);
  for (const TileIndex tile : tiles) {
    for (std::size_t offset = 0; offset < kTileCells; ++offset) {
      const CellIndex cell = cell_at(tile, offset);
      const CellIndex old = grid.frame.cell_of(old_from_new * grid.frame.centre_of(cell));
      if (grid.occupancy[old].is_mapped()) result.occupancy.edit(cell) = grid.occupancy[old];
      if (grid.markers[old].votes() > 0.0F) result.markers.edit(cell) = grid.markers[old];
    }
  }
  return result;
}

/// NDT cells overlap; those of even row and column hold each point exactly once. Their points are
/// replaced by 2 * kSamplesAlong samples with the same mean and covariance.
void add_transformed(const NdtMap& walls, const Se2& new_from_old, NdtMap& result) {
  for (const NdtCellSums& cell : walls.sums()) {
    if (cell.column % 2 != 0 || cell.row % 2 != 0) continue;
    const Eigen::Vector2d mean = cell.sum_m / cell.count;
    const double xx = cell.squares_m2[0] / cell.count - mean.x() * mean.x();
    const double xy = cell.squares_m2[1] / cell.count - mean.x() * mean.y();
    const double yy = cell.squares_m2[2] / cell.count - mean.y() * mean.y();
    const double radius = std::hypot(0.5 * (xx - yy), xy);
    const double direction_rad = 0.5 * std::atan2(2.0 * xy, xx - yy);
    const Eigen::Vector2d along{std::cos(direction_rad), std::sin(direction_rad)};
    const Eigen::Vector2d across{-along.y(), along.x()};
    const double along_sigma_m = std::sqrt(std::max(0.0, 0.5 * (xx + yy) + radius));
    const double across_sigma_m = std::sqrt(std::max(0.0, 0.5 * (xx + yy) - radius));
    const Eigen::Vector2d centre = walls.spacing_m() * Eigen::Vector2d{cell.column, cell.row};
    // Evenly spaced samples at -a..a have the variance a^2 (n + 1) / (3 (n - 1)).
    const double reach = std::sqrt(3.0 * (kSamplesAlong - 1) / (kSamplesAlong + 1));
    for (int i = 0; i < kSamplesAlong; ++i) {
      const double place = reach * along_sigma_m * (2.0 * i / (kSamplesAlong - 1) - 1.0);
      for (const double side : {-1.0, 1.0}) {
        const Eigen::Vector2d point =
            centre + mean + place * along + side * across_sigma_m * across;
        result.add(new_from_old * point, 0, cell.count / (2.0 * kSamplesAlong));
      }
    }
  }
}

using Markers = std::vector<SharedMarker>;

Se2 fit_of(const Markers& markers) {
  std::vector<PointPair> pairs;
  for (const SharedMarker& marker : markers)
    pairs.push_back({marker.in_a, marker.in_b});
  return rigid_fit(pairs);
}

Markers inliers_of(const Markers& markers, const Se2& a_from_b) {
  Markers agree;
  std::copy_if(markers.begin(), markers.end(), std::back_inserter(agree),
               [&](const SharedMarker& marker) { return marker.agrees(a_from_b); });
  return agree;
}

/// Mean of two estimates, weighted by information.
Landmark mean_of(const Landmark& a, const Landmark& b) {
  Landmark mean = a;
  const Eigen::Matrix3d gain = a.covariance * (a.covariance + b.covariance).inverse();
  mean.map_from_marker =
      moved_by(a.map_from_marker, gain * pose_difference(b.map_from_marker, a.map_from_marker));
  mean.covariance = a.covariance - gain * a.covariance;
  mean.sightings = a.sightings + b.sightings;
  return mean;
}

/// @param has_moved  the maps disagree about where the only marker of that id is.
void add_landmark(std::vector<Landmark>& landmarks, Landmark landmark, bool has_moved) {
  int instance = 0;
  for (Landmark& known : landmarks) {
    if (known.id != landmark.id) continue;
    if ((known.map_from_marker.translation() - landmark.map_from_marker.translation()).norm() <
        kSameMarker_m) {
      if (!has_moved)
        known = mean_of(known, landmark);
      else if (known.last_seen < landmark.last_seen)
        known = landmark;
      return;
    }
    instance = std::max(instance, known.instance + 1);
  }
  landmark.instance = instance;
  landmarks.push_back(landmark);
}

template <class Cell, class Add>
void add_cells(const TileMap<Cell>& from, TileMap<Cell>& to, Add&& add) {
  from.for_each_tile([&](TileIndex index, const auto& cells) {
    for (std::size_t offset = 0; offset < kTileCells; ++offset)
      if (cells[offset] != Cell{}) add(cells[offset], to.edit(cell_at(index, offset)));
  });
}

}  // namespace

MapSnapshot transformed(const MapSnapshot& map, const Se2& new_from_old) {
  MapSnapshot result = map;
  result.grid = transformed(map.grid, new_from_old);
  result.walls = NdtMap{map.walls.spacing_m()};
  add_transformed(map.walls, new_from_old, result.walls);
  for (Landmark& landmark : result.landmarks) {
    landmark.map_from_marker = new_from_old * landmark.map_from_marker;
    landmark.covariance = in_axes(new_from_old.rotation(), landmark.covariance);
  }
  for (Se2& pose : result.graph.poses)
    pose = new_from_old * pose;
  return result;
}

std::optional<MapAlignment> align_by_markers(const MapSnapshot& a, const MapSnapshot& b) {
  const Markers shared = shared_markers(a, b);
  Markers best;
  for (std::size_t i = 0; i < shared.size(); ++i) {
    for (std::size_t k = i + 1; k < shared.size(); ++k) {
      if ((shared[i].in_a - shared[k].in_a).norm() < kMinApart_m) continue;
      const Markers agree = inliers_of(shared, fit_of({shared[i], shared[k]}));
      if (agree.size() > best.size()) best = agree;
    }
  }
  // The fit of all of them is better than that of two, and may leave out a marker that was moved.
  for (int i = 0; i < kRefinements && best.size() >= 2; ++i)
    best = inliers_of(shared, fit_of(best));
  if (best.size() < 2) return std::nullopt;
  MapAlignment alignment{fit_of(best), best.size(), 0.0};
  for (const SharedMarker& marker : best)
    alignment.rms_m += std::pow(marker.apart_m(alignment.a_from_b), 2);
  alignment.rms_m = std::sqrt(alignment.rms_m / static_cast<double>(best.size()));
  return alignment;
}

MapSnapshot merged(const MapSnapshot& a, const MapSnapshot& b, const Se2& a_from_b) {
  MapSnapshot result = a;
  const MapSnapshot other = transformed(b, a_from_b);
  result.parent_map_id = a.map_id;
  result.time = std::max(a.time, b.time);
  add_cells(other.grid.occupancy, result.grid.occupancy,
            [](const OccupancyCell& from, OccupancyCell& to) {
              to.hits += from.hits;
              to.visits += from.visits;
            });
  add_cells(other.grid.markers, result.grid.markers, [](const MarkerCell& from, MarkerCell& to) {
    to.vote(kNoMarker, from.none);
    for (const MarkerCell::Votes& votes : from.ids)
      if (votes.id != kNoMarker) to.vote(votes.id, votes.count);
  });
  for (const NdtCellSums& cell : other.walls.sums())
    result.walls.add(cell);
  std::set<int> moved;
  for (const SharedMarker& marker : shared_markers(a, b))
    if (!marker.agrees(a_from_b)) moved.insert(marker.id);
  for (const Landmark& landmark : other.landmarks)
    add_landmark(result.landmarks, landmark, moved.contains(landmark.id));
  std::stable_sort(result.landmarks.begin(), result.landmarks.end(),
                   [](const Landmark& x, const Landmark& y) {
                     return std::pair{x.id, x.instance} < std::pair{y.id, y.instance};
                   });
  const std::size_t offset = result.graph.poses.size();
  result.graph.poses.insert(result.graph.poses.end(), other.graph.poses.begin(),
                            other.graph.poses.end());
  for (GraphEdge edge : other.graph.edges) {
    edge.from += offset;
    edge.to += offset;
    result.graph.edges.push_back(edge);
  }
  return result;
}

}  // namespace waymark
