// SPDX-License-Identifier: BSD-3-Clause
// What lies around the cells in which beams end, read from the map once and not for every pose.
#pragma once

#include "slam/core/gmapping/hit_map.hpp"

#include <Eigen/Core>

#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <vector>

namespace waymark {

/// Where a beam ends, and where it has to be free before that.
struct BeamCells {
  CellIndex end{};
  CellIndex before{};

  bool operator==(const BeamCells&) const = default;
};

/// The hits within `reach` cells of a beam's end, remembered per cell: the hundred poses of a climb
/// ask for the same few thousand cells. The map must not change meanwhile.
/// Four hits at once and one cache line for the first four: tests/benchmark/gmapping_speed.cpp
class Surroundings {
 public:
  /// @param needs_free_cell  leave out hits of which the cell at the same offset from `before` is
  /// hit.
  Surroundings(const HitMap& map, int reach, bool needs_free_cell);

  static constexpr float kNothingAround = std::numeric_limits<float>::infinity();

  /// Squared distance [cells^2] from the beam's end to the nearest mean of a hit cell;
  /// kNothingAround when there is none.
  /// @param from_centre_x  and
  /// @param from_centre_y  of the end, in cells from the centre of its cell.
  float nearest_squared(const BeamCells& beam, float from_centre_x, float from_centre_y) {
    const std::size_t slot = slot_of(beam.end);
    const Entry& entry = entries_[slot];
    if (entry.beam != beam) read(beam, slot);
    if (entry.groups == 0) return kNothingAround;
    Eigen::Array4f nearest = entry.first.squared(from_centre_x, from_centre_y);
    const FourHits* const more = &more_[slot * max_more_];
    for (std::uint32_t group = 1; group < entry.groups; ++group)
      nearest = nearest.min(more[group - 1].squared(from_centre_x, from_centre_y));
    return nearest.minCoeff();
  }

 private:
  /// Means of hit cells, in cells from the centre of the beam's end cell; empty places are
  /// infinite.
  struct FourHits {
    Eigen::Array4f x;
    Eigen::Array4f y;

    Eigen::Array4f squared(float from_x, float from_y) const {
      return (x - from_x).square() + (y - from_y).square();
    }
  };

  struct alignas(64) Entry {
    FourHits first;
    BeamCells beam{kNoCell, kNoCell};
    std::uint32_t groups{0};  ///< of four hits; the first is here, the others in more_
  };

  static constexpr CellIndex kNoCell{std::numeric_limits<int>::min(), 0};
  static constexpr int kSlotBits = 12;

  /// Multiplicative hash (Knuth): cells along a wall, also an oblique one, get slots of their own.
  static std::size_t slot_of(CellIndex cell) {
    const std::uint32_t mixed = static_cast<std::uint32_t>(cell.x) * 0x9e3779b1U +
                                static_cast<std::uint32_t>(cell.y) * 0x85ebca77U;
    return mixed >> (32 - kSlotBits);
  }

  void read(const BeamCells& beam, std::size_t slot);

  const HitMap& map_;
  int reach_;
  bool needs_free_cell_;
  std::size_t max_more_;  ///< groups of a slot in more_
  std::vector<Entry> entries_;
  std::unique_ptr<FourHits[]> more_;  ///< not initialised: entries_ say what is there
};

}  // namespace waymark
