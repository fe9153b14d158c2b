// SPDX-License-Identifier: BSD-3-Clause
// Files that slam reads before it starts: a map, and surveyed markers.
#pragma once

#include "slam/core/landmark/surveyed_marker.hpp"
#include "slam/core/localisation/map_snapshot.hpp"
#include "slam/slam_config.hpp"

#include <memory>
#include <string>
#include <vector>

namespace waymark {

/// The map of --load-map. With slam.start = last, and if an earlier run was interrupted while
/// mapping to --save-map, the map of that file, which is then extended; another map in that file is
/// kept (config.keeps_old_map).
/// @param config  in: as configured; out: load_map, mode and start as they are used.
/// @param frame   out: name of the frame that the map is in, or will be.
/// @return nullptr: no map is to be loaded.
/// @throws SetupError  if the map cannot be read or does not suit this robot, the options for
///                     loading and saving contradict each other, or a file that is not a map would
///                     be replaced.
std::shared_ptr<const MapSnapshot> load_map(SlamConfig& config, std::string& frame);

/// The surveyed markers. With a loaded map, whose frame is already defined, they are only checked.
/// @throws SetupError
std::vector<SurveyedMarker> load_survey(const SlamConfig& config);

}  // namespace waymark
