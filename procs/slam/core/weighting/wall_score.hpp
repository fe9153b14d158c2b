// SPDX-License-Identifier: BSD-3-Clause
// Agreement of beam ends with mapped walls, which constrains heading and lateral position.
#pragma once

#include "slam/core/grid/grid_map.hpp"
#include "slam/core/scan/annotated_scan.hpp"

#include <span>

namespace waymark {

struct WallScore {
  double agreement{0.0};  ///< sum over beams of the occupancy where they end
  double mapped{0.0};     ///< number of beams (fractional) that end in mapped cells

  /// Agreement beyond what is expected of `mapped` beams at the correct pose. Beams that end in
  /// unmapped cells contribute nothing.
  double beyond(double expected_per_beam) const { return agreement - expected_per_beam * mapped; }
};

WallScore wall_score(const GridMap& map, std::span<const AnnotatedBeam> beams,
                     const Se2& map_from_base);

}  // namespace waymark
