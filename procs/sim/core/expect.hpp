// SPDX-License-Identifier: BSD-3-Clause
// What a scenario demands of the estimator: carried along for waymark-evaluate, nothing here acts
// on it.
#pragma once

#include "common/config/config.hpp"

#include <string>

namespace waymark {

/// Upper limits unless said; 0 = not checked.
struct ExpectConfig {
  std::string estimator{"waymark"};
  double length_error_percent{0.0};
  double ate_origin_m{0.0};
  double marker_map_share{0.0};  ///< a lower limit
  double found_again_s{0.0};
  double says_lost_s{0.0};
  double max_jump_m{0.0};
  int max_wall_cells{0};

  void describe(Fields& fields);
};

}  // namespace waymark
