// SPDX-License-Identifier: BSD-3-Clause
// Map files, NAME.map.lcm: an LCM log of MAP_HEADER, SLAM_MAP, SLAM_MARKERS, MAP_WALLS, MAP_GRAPH
// and MAP_CALIBRATION, so that every reader of our logs reads maps, too.
#pragma once

#include "common/errors/setup_error.hpp"
#include "common/messages/message.hpp"
#include "slam/core/graph/map_snapshot.hpp"

#include <filesystem>
#include <string>
#include <vector>

namespace waymark {

/// What a map was made with.
struct MapFileInfo {
  std::string marker_dictionary{};
  double marker_size_m{0.0};  ///< side of the black square
  std::string frame{"map"};
};

struct MapFile {
  MapSnapshot map{};
  MapFileInfo info{};
};

/// A map as messages, the header first. Their map_id is the hash of their content.
std::vector<Message> to_map_messages(const MapSnapshot& map, const MapFileInfo& info);

/// The map that these messages are: as if it had been saved and loaded.
MapFile map_of(const std::vector<Message>& messages);

/// Writes to a temporary name and renames: a map file that is there is whole.
/// @return the map's id.
/// @throws std::runtime_error naming the file.
std::int64_t write_map_file(const std::filesystem::path& file, const MapSnapshot& map,
                            const MapFileInfo& info);

/// @throws SetupError  in one sentence: not there, not a map, of another format, damaged, cut off.
MapFile read_map_file(const std::filesystem::path& file);

}  // namespace waymark
