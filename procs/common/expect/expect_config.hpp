// SPDX-License-Identifier: BSD-3-Clause
// What a scenario expects of an estimator. Only waymark-evaluate uses it.
#pragma once

#include "common/config/fields.hpp"

#include <string>

namespace waymark {

/// Section [expect] of a scenario; 0 = no expectation. The last two limit statistics over all seeds
/// of a sweep, the others every run.
struct ExpectConfig {
  std::string estimator{"waymark"};
  double length_error_percent{0.0};
  double ate_origin_m{0.0};
  double along_rmse_m{0.0};
  double across_rmse_m{0.0};
  double heading_rmse_deg{0.0};
  double marker_error_mean_m{0.0};
  double marker_map_share{0.0};
  double moved_named_share{0.0};
  double found_again_s{0.0};
  double says_lost_s{0.0};
  double confident_wrong_s{0.0};
  double max_jump_m{0.0};
  double max_wall_cells{0.0};
  double memory_mb_per_m{0.0};
  double nees_mean{0.0};
  double sigma_growth{0.0};
  double sigma_growth_from_m{0.0};
  double sigma_growth_to_m{0.0};
  double nees_in_band_share{0.0};
  double seeds_share{0.0};

  /// Names, units and explanations of the keys: expect_config.cpp.
  void describe(Fields& fields);
};

/// expect.toml beside a recorded run, used in place of section [expect] of its scenario.
struct ExpectFile {
  ExpectConfig expect{};

  void describe(Fields& fields) { fields.section("expect", expect); }
};

}  // namespace waymark
