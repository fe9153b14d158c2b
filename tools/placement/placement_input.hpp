// SPDX-License-Identifier: BSD-3-Clause
// Reads the input of a placement from a run's row, or from a map file.
#pragma once

#include "evaluate/trajectory/nees.hpp"
#include "placement/drive.hpp"
#include "placement/occupied_walls.hpp"
#include "slam/slam_config.hpp"

#include <filesystem>
#include <optional>
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
  std::vector<ScanPlace> places{};  ///< the path, by the final estimate
  std::vector<MappedMarker> markers{};
  std::optional<double> marker_height_m{};  ///< height of their centres; nullopt = the camera's
  PlacedMapImage image{};
  std::vector<evaluate::StampedCovariance> covariances{};  ///< reported during the run, if any
  std::vector<std::string> notes{};  ///< assumptions and omissions, one sentence each
};

/// @param source  folder of a run (its row of the estimator waymark is read) or row, or a map file.
/// @param config  robot.toml or a slam configuration; its keys win over the row's own; empty: none.
/// @throws SetupError for unusable input.
PlacementInput read_placement_input(const std::filesystem::path& source,
                                    const std::filesystem::path& config);

}  // namespace waymark::placement
