// SPDX-License-Identifier: BSD-3-Clause
// What a scenario expects of an estimator: written in the scenario, checked by waymark-evaluate,
// known to nobody else.
#pragma once

#include "common/config/fields.hpp"

#include <string>

namespace waymark {

/// Section [expect] of a scenario. 0 = nothing is expected of that figure. The last two are about
/// all seeds of a sweep, the others about every run.
struct ExpectConfig {
  std::string estimator{"waymark"};  ///< the rows that shall reach it; empty = all
  double length_error_percent{0.0};  ///< of the map image, at most
  double ate_origin_m{0.0};          ///< at most
  double along_rmse_m{0.0};          ///< at most
  double across_rmse_m{0.0};         ///< at most
  double heading_rmse_deg{0.0};      ///< at most
  double marker_error_mean_m{0.0};   ///< at most
  double marker_map_share{0.0};      ///< of markers, true and estimated, that are right, at least
  double moved_named_share{0.0};     ///< of the moved markers that are named as such, at least
  double found_again_s{0.0};         ///< after the first sighting since a kidnap, at most
  double says_lost_s{0.0};           ///< after that sighting, at most, unless found by then
  double confident_wrong_s{0.0};     ///< wrong and sure of it after that sighting, at most
  double max_jump_m{0.0};            ///< of the pose from one estimate to the next, at most
  double max_wall_cells{0.0};        ///< thickness of the walls on the map image, at most
  double memory_mb_per_m{0.0};       ///< of the estimator for each metre driven, at most
  double nees_mean{0.0};             ///< of a run's poses; 3 is right; at most
  double sigma_growth{0.0};          ///< along, from one station to another, at least
  double sigma_growth_from_m{0.0};   ///< driven
  double sigma_growth_to_m{0.0};     ///< driven
  double nees_in_band_share{0.0};    ///< of the stations, with the mean over all seeds, at least
  double seeds_share{0.0};           ///< of the seeds that reach all of the above; 0 = all seeds

  void describe(Fields& fields);
};

/// expect.toml beside a recorded run: stands for the section of its scenario.
struct ExpectFile {
  ExpectConfig expect{};

  void describe(Fields& fields) { fields.section("expect", expect); }
};

}  // namespace waymark
