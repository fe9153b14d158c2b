// SPDX-License-Identifier: BSD-3-Clause
// The LiDAR's observations of a cell.
#pragma once

#include <cstdint>

namespace waymark {

/// Beams that ended in the cell, and beams that ended in it or crossed it.
struct OccupancyCell {
  std::uint32_t hits{0};
  std::uint32_t visits{0};

  bool is_mapped() const { return visits > 0; }

  /// Share of the beams reaching this cell that ended in it; 0 when unmapped.
  double occupancy() const {
    return visits > 0 ? static_cast<double>(hits) / static_cast<double>(visits) : 0.0;
  }

  bool operator==(const OccupancyCell&) const = default;
};

}  // namespace waymark
