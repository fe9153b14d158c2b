// SPDX-License-Identifier: BSD-3-Clause
// What lies around the cells in which beams end, read from the map once and not for every pose.
#pragma once

#include "slam/core/gmapping/hit_map.hpp"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace waymark {

/// Where a beam ends, and where it has to be free before that.
struct BeamCells {
  CellIndex end{};
  CellIndex before{};

  bool operator==(const BeamCells&) const = default;
};

/// The hits within `reach` cells of a beam's end, remembered per cell: the thousand poses of a
/// climb ask for the same few thousand cells. The map must not change meanwhile.
/// tests/benchmark/gmapping_benchmark.cpp
class Surroundings {
 public:
  /// Mean of a hit cell, in cells from the centre of the beam's end cell.
  struct Hit {
    float x;
    float y;
  };

  /// @param needs_free_cell  leave out hits of which the cell at the same offset from `before` is
  /// hit.
  Surroundings(const HitMap& map, int reach, bool needs_free_cell);

  std::span<const Hit> of(BeamCells beam) {
    const std::size_t slot = slot_of(beam.end);
    if (!entries_[slot].is_read || entries_[slot].beam != beam) read(beam, slot);
    return {&hits_[slot * max_hits_], entries_[slot].count};
  }

 private:
  struct Entry {
    BeamCells beam{};
    std::uint32_t count{0};
    bool is_read{false};
  };

  static constexpr int kSlotBits = 12;

  /// Multiplicative hash (Knuth): cells along a wall, also an oblique one, get slots of their own.
  static std::size_t slot_of(CellIndex cell) {
    const std::uint32_t mixed = static_cast<std::uint32_t>(cell.x) * 0x9e3779b1U +
                                static_cast<std::uint32_t>(cell.y) * 0x85ebca77U;
    return mixed >> (32 - kSlotBits);
  }

  void read(BeamCells beam, std::size_t slot);

  const HitMap& map_;
  int reach_;
  bool needs_free_cell_;
  std::size_t max_hits_;
  std::vector<Entry> entries_;
  std::vector<Hit> hits_;
};

}  // namespace waymark
