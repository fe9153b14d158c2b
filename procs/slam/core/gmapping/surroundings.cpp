// SPDX-License-Identifier: BSD-3-Clause
#include "slam/core/gmapping/surroundings.hpp"

namespace waymark {

Surroundings::Surroundings(const HitMap& map, int reach, bool needs_free_cell)
    : map_{map},
      reach_{reach},
      needs_free_cell_{needs_free_cell},
      max_hits_{static_cast<std::size_t>((2 * reach + 1) * (2 * reach + 1))},
      entries_(std::size_t{1} << kSlotBits),
      hits_(max_hits_ << kSlotBits) {}

void Surroundings::read(BeamCells beam, std::size_t slot) {
  Hit* const first = &hits_[slot * max_hits_];
  Hit* next = first;
  const CellIndex free_offset{beam.before.x - beam.end.x, beam.before.y - beam.end.y};
  visit_hits_around(map_, beam.end, reach_, [&](CellIndex cell, const HitCell& hit) {
    if (needs_free_cell_ && is_hit(map_, {cell.x + free_offset.x, cell.y + free_offset.y})) return;
    *next++ = {static_cast<float>(cell.x - beam.end.x) + hit.mean_x,
               static_cast<float>(cell.y - beam.end.y) + hit.mean_y};
  });
  entries_[slot] = {beam, static_cast<std::uint32_t>(next - first), true};
}

}  // namespace waymark
