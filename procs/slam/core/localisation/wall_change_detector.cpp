// SPDX-License-Identifier: BSD-3-Clause
#include "slam/core/localisation/wall_change_detector.hpp"

#include "slam/core/localisation/map_fit.hpp"
#include "slam/core/mapping/insert_scan.hpp"

#include <map>
#include <utility>

namespace waymark {
namespace {

constexpr std::uint32_t kMinVisits = 8;    // beams; a person walking past leaves fewer
constexpr double kWall = 0.5;              // least occupancy of a wall
constexpr int kAgedEvery = 100;            // scans
constexpr std::uint32_t kMaxVisits = 200;  // a cell with more gets its counts halved
constexpr std::size_t kMinCells = 6;       // 0.3 m of wall in cells of 0.05 m
constexpr int kGap = 2;                    // between neighbours in a cluster, at most [cells]

template <class Condition>
bool all_around(CellIndex centre, Condition&& holds) {
  for (int x = -1; x <= 1; ++x)
    for (int y = -1; y <= 1; ++y)
      if (!holds(CellIndex{centre.x + x, centre.y + y})) return false;
  return true;
}

using Cells = std::map<std::pair<int, int>, bool>;  ///< (y, x): whether it is in a cluster

/// Flood fill from the first cell.
std::vector<CellIndex> cluster_from(const std::pair<int, int>& first, Cells& cells) {
  std::vector<CellIndex> cluster;
  std::vector<std::pair<int, int>> open{first};
  cells.at(first) = true;
  while (!open.empty()) {
    const auto [y, x] = open.back();
    open.pop_back();
    cluster.push_back({x, y});
    for (int dy = -kGap; dy <= kGap; ++dy) {
      for (int dx = -kGap; dx <= kGap; ++dx) {
        const auto near = cells.find({y + dy, x + dx});
        if (near == cells.end() || near->second) continue;
        near->second = true;
        open.push_back(near->first);
      }
    }
  }
  return cluster;
}

MapChange change_of(const std::vector<CellIndex>& cluster, MapChange::Kind kind,
                    const GridFrame& frame) {
  Eigen::Vector2d least = frame.centre_of(cluster.front());
  Eigen::Vector2d most = least;
  for (const CellIndex cell : cluster) {
    least = least.cwiseMin(frame.centre_of(cell));
    most = most.cwiseMax(frame.centre_of(cell));
  }
  MapChange change;
  change.kind = kind;
  change.was_at = 0.5 * (least + most);
  change.place = {change.was_at, 0.0};
  change.size_m = (most - least).maxCoeff() + frame.resolution_m;
  change.support = static_cast<int>(cluster.size());
  return change;
}

void add_clusters(Cells cells, MapChange::Kind kind, const GridFrame& frame,
                  std::vector<MapChange>& changes) {
  for (auto& [place, is_taken] : cells) {
    if (is_taken) continue;
    const std::vector<CellIndex> cluster = cluster_from(place, cells);
    if (cluster.size() >= kMinCells) changes.push_back(change_of(cluster, kind, frame));
  }
}

}  // namespace

WallChangeDetector::WallChangeDetector(std::shared_ptr<const MapSnapshot> map)
    : map_{std::move(map)}, seen_{map_->grid.frame, {}, {}} {}

void WallChangeDetector::add(const Observation& observation, const Se2& map_from_base) {
  const CellIndex here = map_->grid.frame.cell_of(map_from_base.translation());
  if (!map_->grid.occupancy[here].is_mapped()) return;
  insert_beams(observation.beams, map_from_base, seen_);
  if (++num_scans_ % kAgedEvery == 0) age();
}

/// Halves large counts, so that old observations fade.
void WallChangeDetector::age() {
  std::vector<TileIndex> tiles;
  seen_.occupancy.for_each_tile([&](TileIndex tile, const auto&) { tiles.push_back(tile); });
  for (const TileIndex tile : tiles) {
    for (OccupancyCell& cell : seen_.occupancy.edit_tile(tile)) {
      if (cell.visits <= kMaxVisits) continue;
      cell.visits /= 2;
      cell.hits /= 2;
    }
  }
}

std::vector<MapChange> WallChangeDetector::changes() const {
  const auto& then = map_->grid.occupancy;
  const auto& now = seen_.occupancy;
  const auto was_free = [&](CellIndex cell) {
    return then[cell].is_mapped() && then[cell].occupancy() < kFreeOccupancy;
  };
  const auto is_free = [&](CellIndex cell) {
    return now[cell].visits >= kMinVisits && now[cell].occupancy() < kFreeOccupancy;
  };
  Cells appeared;
  Cells gone;
  now.for_each_tile([&](TileIndex tile, const auto& cells) {
    for (std::size_t offset = 0; offset < kTileCells; ++offset) {
      if (cells[offset].visits < kMinVisits) continue;
      const CellIndex cell = cell_at(tile, offset);
      if (cells[offset].occupancy() > kWall && all_around(cell, was_free))
        appeared[{cell.y, cell.x}] = false;
      if (then[cell].occupancy() > kWall && all_around(cell, is_free))
        gone[{cell.y, cell.x}] = false;
    }
  });
  std::vector<MapChange> changes;
  add_clusters(std::move(appeared), MapChange::Kind::kWallNew, map_->grid.frame, changes);
  add_clusters(std::move(gone), MapChange::Kind::kWallGone, map_->grid.frame, changes);
  return changes;
}

}  // namespace waymark
