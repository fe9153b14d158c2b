// SPDX-License-Identifier: BSD-3-Clause
// The sub-command `placement`.
#pragma once

#include <filesystem>

namespace waymark::placement {

struct PlacementOptions {
  std::filesystem::path source{};  ///< run, row or map file
  double target_m{0.02};
  std::filesystem::path config{};   ///< robot.toml or slam configuration; empty: the row's own
  std::filesystem::path json{};     ///< empty: none
  std::filesystem::path csv{};      ///< empty: none
  std::filesystem::path picture{};  ///< empty: placement.png beside the map
};

/// Prints the result and writes the files.
/// @return 0: the target is met, now or with the new markers; 1: it cannot be met.
/// @throws evaluate::InputError, ConfigError, SetupError for unusable input.
int run_placement(const PlacementOptions& options);

}  // namespace waymark::placement
