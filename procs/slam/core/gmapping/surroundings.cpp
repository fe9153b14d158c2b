// SPDX-License-Identifier: BSD-3-Clause
#include "slam/core/gmapping/surroundings.hpp"

namespace waymark {
namespace {

constexpr std::size_t kHitsPerGroup = 4;

std::size_t max_groups(int reach) {
  const auto side = static_cast<std::size_t>(2 * reach + 1);
  return (side * side + kHitsPerGroup - 1) / kHitsPerGroup;
}

}  // namespace

Surroundings::Surroundings(const HitMap& map, int reach, bool needs_free_cell)
    : map_{map},
      reach_{reach},
      needs_free_cell_{needs_free_cell},
      max_more_{max_groups(reach) - 1},
      entries_(std::size_t{1} << kSlotBits),
      more_{std::make_unique_for_overwrite<FourHits[]>(max_more_ << kSlotBits)} {}

void Surroundings::read(const BeamCells& beam, std::size_t slot) {
  Entry& entry = entries_[slot];
  entry.beam = beam;
  entry.groups = 0;
  std::size_t hits = 0;
  FourHits* group = nullptr;
  const CellIndex free_offset{beam.before.x - beam.end.x, beam.before.y - beam.end.y};
  visit_hits_around(map_, beam.end, reach_, [&](CellIndex cell, const HitCell& hit) {
    if (needs_free_cell_ && is_hit(map_, {cell.x + free_offset.x, cell.y + free_offset.y})) return;
    const auto place = static_cast<Eigen::Index>(hits++ % kHitsPerGroup);
    if (place == 0) {
      group = entry.groups == 0 ? &entry.first : &more_[slot * max_more_ + entry.groups - 1];
      group->x.setConstant(kNothingAround);
      group->y.setConstant(kNothingAround);
      ++entry.groups;
    }
    group->x[place] = static_cast<float>(cell.x - beam.end.x) + hit.mean_x;
    group->y[place] = static_cast<float>(cell.y - beam.end.y) + hit.mean_y;
  });
}

}  // namespace waymark
