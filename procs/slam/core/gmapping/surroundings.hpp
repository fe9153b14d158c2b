// SPDX-License-Identifier: BSD-3-Clause
// Hits around the cells in which beams end, cached so that the map is not read for every pose.
#pragma once

#include "slam/core/gmapping/hit_map.hpp"

#include <Eigen/Core>

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <vector>

namespace waymark {

/// The cell in which a beam ends, and the cell before it that has to be free.
struct BeamCells {
  CellIndex end{};
  CellIndex before{};

  bool operator==(const BeamCells&) const = default;
};

/// The hits within `reach` cells of a beam's end, cached per cell: the hundred poses of a climb
/// read the same few thousand cells. The map must not change meanwhile. Eight hits are compared
/// without a branch, in one cache line. Benchmark: tests/benchmark/gmapping_speed.cpp.
class Surroundings {
 public:
  /// @param needs_free_cell  leave out a hit if the cell in front of it is hit, too, that is the
  ///                         cell at the offset from `end` to `before`.
  Surroundings(const HitMap& map, int reach, bool needs_free_cell);

  static constexpr float kNothingAround = std::numeric_limits<float>::infinity();

  /// Squared distance [cells^2] from the beam's end to the nearest mean of a hit cell;
  /// kNothingAround when there is none.
  /// @param from_centre_x  x of the end from the centre of its cell [cells],
  /// @param from_centre_y  and y.
  float nearest_squared(const BeamCells& beam, float from_centre_x, float from_centre_y) {
    const std::size_t slot = slot_of(beam.end);
    const Key& key = keys_[slot];
    if (key.beam != beam) [[unlikely]]
      read(beam, slot);
    Eigen::Array4f nearest = nearest_[slot].squared(from_centre_x, from_centre_y);
    for (std::uint32_t i = 0; i < key.overflow; ++i)
      nearest =
          nearest.min(overflow_[slot * max_overflow_ + i].squared(from_centre_x, from_centre_y));
    return nearest.minCoeff();
  }

 private:
  /// Means of hit cells [cells], relative to the centre of the beam's end cell; unused ones are
  /// infinite.
  struct alignas(64) EightHits {
    std::array<Eigen::Array4f, 2> x;
    std::array<Eigen::Array4f, 2> y;

    Eigen::Array4f squared(float from_x, float from_y) const {
      const Eigen::Array4f low = (x[0] - from_x).square() + (y[0] - from_y).square();
      const Eigen::Array4f high = (x[1] - from_x).square() + (y[1] - from_y).square();
      return low.min(high);
    }
  };

  struct Key {
    BeamCells beam{kNoCell, kNoCell};
    std::uint32_t overflow{0};  ///< number of groups of eight hits in overflow_
  };

  static constexpr CellIndex kNoCell{std::numeric_limits<int>::min(), 0};
  static constexpr int kSlotBits = 13;
  static constexpr std::size_t kSlots = std::size_t{1} << kSlotBits;

  /// Multiplicative hash (Knuth): cells along a wall, also an oblique one, get different slots.
  static std::size_t slot_of(CellIndex cell) {
    const std::uint32_t mixed = static_cast<std::uint32_t>(cell.x) * 0x9e3779b1U +
                                static_cast<std::uint32_t>(cell.y) * 0x85ebca77U;
    return mixed >> (32 - kSlotBits);
  }

  void read(const BeamCells& beam, std::size_t slot);

  const HitMap& map_;
  int reach_;
  bool needs_free_cell_;
  std::size_t max_overflow_;  ///< capacity per slot in overflow_, in groups of eight hits
  std::vector<Key> keys_;
  // Not initialised: valid where keys_ has an entry.
  std::unique_ptr<EightHits[]> nearest_;
  std::unique_ptr<EightHits[]> overflow_;
};

}  // namespace waymark
