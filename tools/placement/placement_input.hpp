// SPDX-License-Identifier: BSD-3-Clause
// What a placement is made from: a run's row, or a map file.
#pragma once

#include "evaluate/trajectory/nees.hpp"
#include "placement/drive.hpp"
#include "placement/occupied_walls.hpp"
#include "slam/slam_config.hpp"

#include <filesystem>
#include <string>
#include <vector>

namespace waymark::placement {

struct MappedMarker {
  int id{kNoMarker};
  int instance{0};
  Se2 map_from_marker{};
};

struct PlacementInput {
  std::filesystem::path source{};  ///< the row, or the map file
  SlamConfig config{};
  std::vector<ScanPlace> places{};  ///< the way, as known at the end
  std::vector<MappedMarker> markers{};
  PlacedMapImage image{};
  std::vector<evaluate::StampedCovariance> covariances{};  ///< as shown on line; none of a map
  std::vector<std::string> notes{};  ///< what was assumed or left out, a sentence each
};

/// @param source  folder of a run (then its row of the estimator waymark), of a row, or a map file.
/// @param config  robot.toml or a slam configuration, instead of the row's own; empty: none.
/// @throws evaluate::InputError, ConfigError, SetupError in one sentence each.
PlacementInput read_placement_input(const std::filesystem::path& source,
                                    const std::filesystem::path& config);

}  // namespace waymark::placement
