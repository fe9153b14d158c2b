// SPDX-License-Identifier: BSD-3-Clause
#include "slam/core/gmapping/surroundings.hpp"

namespace waymark {
namespace {

constexpr std::size_t kHitsPerGroup = 8;

std::size_t max_groups(int reach) {
  const auto side = static_cast<std::size_t>(2 * reach + 1);
  return (side * side + kHitsPerGroup - 1) / kHitsPerGroup;
}

}  // namespace

Surroundings::Surroundings(const HitMap& map, int reach, bool needs_free_cell)
    : map_{map},
      reach_{reach},
      needs_free_cell_{needs_free_cell},
      max_overflow_{max_groups(reach) - 1},
      keys_(kSlots),
      nearest_{std::make_unique_for_overwrite<EightHits[]>(kSlots)},
      overflow_{std::make_unique_for_overwrite<EightHits[]>(max_overflow_ * kSlots)} {}

void Surroundings::read(const BeamCells& beam, std::size_t slot) {
  const auto cleared = [](EightHits& hits) {
    for (std::size_t half = 0; half < 2; ++half) {
      hits.x[half].setConstant(kNothingAround);
      hits.y[half].setConstant(kNothingAround);
    }
    return &hits;
  };
  Key& key = keys_[slot];
  key = {beam, 0};
  EightHits* group = cleared(nearest_[slot]);
  std::size_t hits = 0;
  const CellIndex free_offset{beam.before.x - beam.end.x, beam.before.y - beam.end.y};
  visit_touched_around(map_, beam.end, reach_, [&](CellIndex cell, const HitCell& hit) {
    if (needs_free_cell_ && is_hit(map_, {cell.x + free_offset.x, cell.y + free_offset.y})) return;
    if (hits == kHitsPerGroup) {
      group = cleared(overflow_[slot * max_overflow_ + key.overflow++]);
      hits = 0;
    }
    const std::size_t half = hits / 4;
    const auto place = static_cast<Eigen::Index>(hits++ % 4);
    group->x[half][place] = static_cast<float>(cell.x - beam.end.x) + hit.mean_x;
    group->y[half][place] = static_cast<float>(cell.y - beam.end.y) + hit.mean_y;
  });
}

}  // namespace waymark
