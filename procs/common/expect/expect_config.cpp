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
  fields.field("along_rmse_m", along_rmse_m, kAnyNumber,
               "RMS error along the line from start to end, at most");
  fields.field("across_rmse_m", across_rmse_m, kAnyNumber, "RMS error across it, at most");
  fields.field("heading_rmse_deg", heading_rmse_deg, kAnyNumber, "at most");
  fields.field("marker_error_mean_m", marker_error_mean_m, kAnyNumber,
               "mean distance of the markers from their true places, at most");
  fields.field("marker_map_share", marker_map_share, kAnyNumber,
               "share of the markers, true and estimated, that are right, at least");
  fields.field("moved_named_share", moved_named_share, kAnyNumber,
               "share of the markers that were moved, or are said to be, that are both, at least");
  fields.field(
      "found_again_s", found_again_s, kAnyNumber,
      "time from the first sighting after a kidnap until the pose is right again, at most");
  fields.field("says_lost_s", says_lost_s, kAnyNumber,
               "time from that sighting until the health is lost (or the pose right), at most");
  fields.field("confident_wrong_s", confident_wrong_s, kAnyNumber,
               "time from that sighting on with a pose that is wrong, sure and not lost, at most");
  fields.field("max_jump_m", max_jump_m, kAnyNumber,
               "correction of the pose from one estimate to the next, at most");
  fields.field("max_wall_cells", max_wall_cells, kAnyNumber,
               "thickness of the walls on the map image [cells], at most");
  fields.field("memory_mb_per_m", memory_mb_per_m, kAnyNumber,
               "peak memory of the estimator over the distance driven, at most");
  fields.field("nees_mean", nees_mean, kAnyNumber,
               "mean NEES of the run's poses (3 is right), at most");
  fields.field(
      "sigma_growth", sigma_growth, kAnyNumber,
      "factor by which the standard deviation along the corridor grows between the next two, "
      "at least");
  fields.field("sigma_growth_from_m", sigma_growth_from_m, kAnyNumber, "driven");
  fields.field("sigma_growth_to_m", sigma_growth_to_m, kAnyNumber, "driven");
  fields.field("nees_in_band_share", nees_in_band_share, kAnyNumber,
               "share of the stations where the mean NEES over all seeds of a sweep lies in its "
               "95 % band, at least");
  fields.field("seeds_share", seeds_share, kAnyNumber,
               "share of a sweep's seeds that reach all of this; 0 = all of them");
}

}  // namespace waymark
