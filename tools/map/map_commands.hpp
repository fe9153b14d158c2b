// SPDX-License-Identifier: BSD-3-Clause
// The sub-commands of waymark-map. All throw SetupError for files that are no maps, for output that
// exists, and for maps that cannot be merged.
#pragma once

#include "common/geometry/se2.hpp"

#include <filesystem>
#include <string>

namespace waymark {

/// Human-readable summary of a map, or one JSON object.
std::string map_info(const std::filesystem::path& file, bool as_json);

/// Writes map.pgm, map.yaml, map.png, markers.csv and graph.g2o into a folder, with the viewer.
/// @throws std::runtime_error if a part of the map is left out (nothing is written then), or a file
/// cannot be written.
void export_map(const std::filesystem::path& file, const std::filesystem::path& folder);

/// Writes the map in another frame.
/// @throws SetupError also if the map would lie too far from the new origin to be stored.
/// @param frame  name of the new frame; empty = keep the name.
/// @return a sentence about the result.
std::string transform_map(const std::filesystem::path& file, const Se2& new_from_old,
                          const std::string& frame, const std::filesystem::path& out);

/// Whether maps are merged whose markers or walls say that they show different buildings.
enum class MergeCheck { kRefuse, kForce };

/// Writes both maps as one, in the frame of `a`.
/// @throws SetupError also if not more than half of the shared markers agree, or the walls of one
/// map stand in the free space of the other, unless forced.
/// @return a sentence about the result.
std::string merge_maps(const std::filesystem::path& a, const std::filesystem::path& b,
                       const std::filesystem::path& out, MergeCheck check = MergeCheck::kRefuse);

}  // namespace waymark
