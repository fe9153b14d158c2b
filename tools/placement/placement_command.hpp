// SPDX-License-Identifier: BSD-3-Clause
// The sub-command `placement`.
#pragma once

#include <filesystem>

namespace waymark::placement {

struct PlacementOptions {
  std::filesystem::path source{};  ///< run, row or map file
  double target_m{0.02};
  std::filesystem::path config{};   ///< robot.toml or slam configuration, over the row's own
  double marker_height_m{0.0};      ///< 0 = as in the run's log, or else the camera's height
  std::filesystem::path json{};     ///< file to write; empty = none
  std::filesystem::path csv{};      ///< file to write; empty = none
  std::filesystem::path picture{};  ///< file to write; empty = placement.png beside the map
};

/// Prints the result and writes the files.
/// @return 0: the target is met, now or with the new markers; 1: no such markers were found.
/// @throws SetupError for unusable input.
int run_placement(const PlacementOptions& options);

}  // namespace waymark::placement
