// SPDX-License-Identifier: BSD-3-Clause
#include "slam/core/gmapping/published_map.hpp"

#include "slam/core/grid/line.hpp"

#include <vector>

namespace waymark {
namespace {

/// Nodes with a scan from `end` (exclusive) to `newest`, newest first; all of them when `end` is
/// not among them.
std::vector<const TrajectoryNode*> nodes_after(const TrajectoryNode* end,
                                               const TrajectoryNode* newest) {
  std::vector<const TrajectoryNode*> nodes;
  for (const TrajectoryNode* node = newest; node != end && node && node->scan;
       node = node->parent.get()) {
    nodes.push_back(node);
  }
  return nodes;
}

bool passes_through(const TrajectoryNode* node, const TrajectoryNode* newest) {
  while (newest && newest != node)
    newest = newest->parent.get();
  return newest != nullptr;
}

}  // namespace

void draw_scan(const StoredScan& scan, const Se2& map_from_base, double usable_range_m,
               GridMap& map) {
  for (const Beam& beam : scan) {
    const bool is_hit = beam.range_m < usable_range_m;
    const double drawn_share = is_hit ? 1.0 : usable_range_m / beam.range_m;
    const Eigen::Vector2d drawn_end_in_base =
        beam.start_in_base + drawn_share * (beam.end_in_base - beam.start_in_base);
    const CellIndex start = map.frame.cell_of(map_from_base * beam.start_in_base);
    const CellIndex end = map.frame.cell_of(map_from_base * drawn_end_in_base);
    visit_line(start, end, [&](CellIndex cell) {
      if (cell != end) ++map.occupancy.edit(cell).visits;
    });
    if (!is_hit) continue;
    OccupancyCell& hit = map.occupancy.edit(end);
    ++hit.hits;
    ++hit.visits;
  }
}

PublishedMap::PublishedMap(const GridFrame& frame, double usable_range_m, double occupied_threshold)
    : final_{frame, {}, {}},
      drawn_{final_},
      thresholded_from_{final_},
      thresholded_{final_},
      usable_range_m_{usable_range_m},
      occupied_threshold_{occupied_threshold} {}

void PublishedMap::finalise(const Trajectory& trunk) {
  for (const TrajectoryNode* node : nodes_after(nullptr, trunk.get())) {
    draw_scan(*node->scan, node->map_from_base, usable_range_m_, final_);
  }
  trunk->scan.reset();
  trunk->parent.reset();
  // Otherwise drawn_until_ would keep the freed trunk, or a dead branch, in memory.
  if (!passes_through(trunk.get(), drawn_until_.get())) drawn_until_.reset();
}

void PublishedMap::draw(const Trajectory& trajectory) {
  if (!drawn_until_ || !passes_through(drawn_until_.get(), trajectory.get())) {
    drawn_ = final_;
    drawn_until_.reset();
  }
  for (const TrajectoryNode* node : nodes_after(drawn_until_.get(), trajectory.get())) {
    draw_scan(*node->scan, node->map_from_base, usable_range_m_, drawn_);
  }
  drawn_until_ = trajectory;
}

void PublishedMap::apply_threshold(TileIndex tile) {
  for (std::size_t offset = 0; offset < kTileCells; ++offset) {
    const CellIndex index = cell_at(tile, offset);
    const OccupancyCell& cell = drawn_.occupancy[index];
    const OccupancyCell thresholded{cell.occupancy() > occupied_threshold_ ? 1U : 0U,
                                    cell.is_mapped() ? 1U : 0U};
    if (thresholded_.occupancy[index] != thresholded)
      thresholded_.occupancy.edit(index) = thresholded;
  }
}

const GridMap& PublishedMap::along(const Trajectory& trajectory) {
  draw(trajectory);
  drawn_.occupancy.for_each_tile([&](TileIndex tile, const auto& cells) {
    if (thresholded_from_.occupancy.tile(tile) != &cells) apply_threshold(tile);
  });
  // Tiles that the previous trajectory had drawn and this one has not.
  thresholded_from_.occupancy.for_each_tile([&](TileIndex tile, const auto&) {
    if (!drawn_.occupancy.tile(tile)) apply_threshold(tile);
  });
  thresholded_from_ = drawn_;
  return thresholded_;
}

}  // namespace waymark
