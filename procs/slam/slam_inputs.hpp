// SPDX-License-Identifier: BSD-3-Clause
// What slam reads before it starts: a map, and surveyed markers.
#pragma once

#include "slam/core/graph/map_snapshot.hpp"
#include "slam/core/landmark/surveyed_marker.hpp"
#include "slam/slam_config.hpp"

#include <memory>
#include <string>
#include <vector>

namespace waymark {

/// The map of --load-map; with slam.start = last the one that a slam before this one was drawing
/// when it stopped, if it had saved it: it is extended then.
/// @param config  as the options have it; afterwards with what is loaded, the mode and the start.
/// @param frame  is given the name of the frame that the map is in, or will be.
/// @return nullptr where no map is to be loaded.
/// @throws SetupError  where the map cannot be read, does not suit this robot, or the options for
///                     loading and saving contradict each other.
std::shared_ptr<const MapSnapshot> load_map(SlamConfig& config, std::string& frame);

/// Markers whose places have been measured; those of a loaded map's frame are checked only.
/// @throws SetupError
std::vector<SurveyedMarker> load_survey(const SlamConfig& config);

}  // namespace waymark
