// SPDX-License-Identifier: BSD-3-Clause
// A ROS map_server map (PGM + YAML) as cells that are free, occupied or unknown.
#pragma once

#include "common/corridor/map_image.hpp"
#include "evaluate/files/text_file.hpp"

#include <Eigen/Core>

#include <filesystem>

namespace waymark::evaluate {

using corridor::Cell;
using corridor::MapImage;

/// Reads map.yaml (`image`, `resolution`, `origin`, `negate`, `occupied_thresh`, `free_thresh`, one
/// `key: value` per line) and the binary 8-bit PGM it names, relative to its own folder.
/// @throws InputError naming file, line and what was expected.
MapImage read_map(const std::filesystem::path& yaml_file);

/// Lower left corner of that image in the map frame [m]; (0, 0) where the file has no `origin`, and
/// its yaw is left aside.
/// @throws InputError as above.
Eigen::Vector2d read_map_origin(const std::filesystem::path& yaml_file);

}  // namespace waymark::evaluate
