// SPDX-License-Identifier: BSD-3-Clause
// Length of a corridor, measured on the map image alone.
#pragma once

#include "common/corridor/map_image.hpp"
#include "common/corridor/not_a_corridor.hpp"

#include <string>
#include <string_view>
#include <vector>

namespace waymark::corridor {

enum class LengthMethod { kStraight, kMedial };

std::string_view name_of(LengthMethod method);

struct CorridorLength {
  double length_px{};
  double length_m{};
  double width_px{};  ///< of the free space between the side walls
  LengthMethod method{};
  /// "curved", "start_wall_missing", "end_wall_missing", "not_elongated". The start is the end with
  /// the smaller x in the map (y, if the corridor runs along y).
  std::vector<std::string> flags{};
};

/// Corridor length: the median, over the central strips (end_wall.hpp), of the distance between the
/// centres of the innermost occupied cells of the two end walls. A straight corridor (its middle
/// stays within a tenth of its width of a straight line) is measured along that line, which is
/// turned to the nearest pixel row or column if it nearly runs along it; a curved corridor is
/// measured along its medial line. At an end without wall, the outer edge of the free space counts.
/// @throws NotACorridor if the map shows no corridor.
CorridorLength measure_corridor(const MapImage& map);

/// 100 (1 - |length - true length| / true length), as in the paper's Table I.
double accuracy_percent(double length_m, double true_length_m);

}  // namespace waymark::corridor
