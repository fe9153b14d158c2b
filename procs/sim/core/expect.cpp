// SPDX-License-Identifier: BSD-3-Clause
#include "sim/core/expect.hpp"

namespace waymark {

void ExpectConfig::describe(Fields& fields) {
  fields.field("estimator", estimator, "whom the limits below hold for; 0 = not checked");
  fields.field("length_error_percent", length_error_percent, kNotNegative,
               "of the corridor's length as measured on the map");
  fields.field("ate_origin_m", ate_origin_m, kNotNegative,
               "RMSE of the positions after alignment on the first pose");
  fields.field("marker_map_share", marker_map_share, kFraction,
               "at least this share of the marker map's entries is right");
  fields.field("found_again_s", found_again_s, kNotNegative,
               "after a kidnap: from the first sighting of a mapped marker to the right pose");
  fields.field("says_lost_s", says_lost_s, kNotNegative,
               "after a kidnap: from the first contradiction to health = lost");
  fields.field("max_jump_m", max_jump_m, kNotNegative, "of the pose between two estimates");
  fields.field("max_wall_cells", max_wall_cells, {0, 1000}, "thickness of every wall on the map");
}

}  // namespace waymark
