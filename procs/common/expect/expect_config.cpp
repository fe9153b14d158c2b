// SPDX-License-Identifier: BSD-3-Clause
#include "common/expect/expect_config.hpp"

namespace waymark {

void ExpectConfig::describe(Fields& fields) {
  fields.field("estimator", estimator, "row that shall reach the figures below; empty = every row");
  fields.field(
      "length_error_percent", length_error_percent, kAnyNumber,
      "length of the map image off by at most this; this and the others: 0 = not expected");
  fields.field("ate_origin_m", ate_origin_m, kAnyNumber,
               "RMS position error after alignment on the first pose, at most");
  fields.field("marker_map_share", marker_map_share, kAnyNumber,
               "share of the markers, true and estimated, that are right, at least");
  fields.field(
      "found_again_s", found_again_s, kAnyNumber,
      "time from the first sighting after a kidnap until the pose is right again, at most");
  fields.field("says_lost_s", says_lost_s, kAnyNumber,
               "time from that sighting until the health is lost (or the pose right), at most");
  fields.field("max_jump_m", max_jump_m, kAnyNumber,
               "correction of the pose from one estimate to the next, at most");
  fields.field("max_wall_cells", max_wall_cells, kAnyNumber,
               "thickness of the walls on the map image [cells], at most");
}

}  // namespace waymark
