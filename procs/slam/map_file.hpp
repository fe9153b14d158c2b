// SPDX-License-Identifier: BSD-3-Clause
// Map files, NAME.map.lcm: an LCM log of MAP_HEADER, SLAM_MAP, SLAM_MARKERS, MAP_WALLS, MAP_GRAPH
// and MAP_CALIBRATION, so that every reader of our logs reads maps, too.
#pragma once

#include "common/errors/setup_error.hpp"
#include "common/messages/message.hpp"
#include "slam/core/localisation/map_snapshot.hpp"

#include <filesystem>
#include <string>
#include <vector>

namespace waymark {

/// Markers and frame of a map.
struct MapFileInfo {
  std::string marker_dictionary{};
  double marker_size_m{0.0};  ///< side of the black square
  std::string frame{"map"};
};

struct MapFile {
  MapSnapshot map{};
  MapFileInfo info{};
};

/// A map as messages, the header first. Their map_id is a hash of their content.
std::vector<Message> to_map_messages(const MapSnapshot& map, const MapFileInfo& info);

/// The map in these messages, as if it had been saved and loaded.
/// @throws std::logic_error  if they are no map.
MapFile map_of(const std::vector<Message>& messages);

/// Atomic, by a temporary name and renaming: a map file that exists is complete; a failed write
/// leaves no file.
/// @return the map's id.
/// @throws std::runtime_error naming the file.
std::int64_t write_map_file(const std::filesystem::path& file, const MapSnapshot& map,
                            const MapFileInfo& info);

/// Renames a map file to the first of FILE.1, FILE.2, ... that does not exist.
/// @return its new name.
/// @throws std::filesystem::filesystem_error
std::filesystem::path move_aside(const std::filesystem::path& file);

/// Whether the file begins as a map file does; the rest of it may be damaged.
/// @throws std::runtime_error saying why the file cannot be read.
bool is_map_file(const std::filesystem::path& file);

/// @throws SetupError  in one sentence: missing, not a map, of another format, damaged, truncated.
MapFile read_map_file(const std::filesystem::path& file);

}  // namespace waymark
