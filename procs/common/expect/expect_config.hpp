// SPDX-License-Identifier: BSD-3-Clause
// What a scenario expects of an estimator: written in the scenario, checked by waymark-evaluate,
// known to nobody else.
#pragma once

#include "common/config/fields.hpp"

#include <string>

namespace waymark {

/// Section [expect] of a scenario. 0 = nothing is expected of that figure.
struct ExpectConfig {
  std::string estimator{"waymark"};  ///< the rows that shall reach it; empty = all
  double length_error_percent{0.0};  ///< of the map image, at most
  double ate_origin_m{0.0};          ///< at most
  double marker_map_share{0.0};      ///< of markers, true and estimated, that are right, at least
  double found_again_s{0.0};         ///< after the first sighting since a kidnap, at most
  double says_lost_s{0.0};           ///< after that sighting, at most, unless found by then
  double max_jump_m{0.0};            ///< of the pose from one estimate to the next, at most
  double max_wall_cells{0.0};        ///< thickness of the walls on the map image, at most

  void describe(Fields& fields);
};

}  // namespace waymark
