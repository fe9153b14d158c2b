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
/// @throws SetupError naming file, line and what was expected.
MapImage read_map(const std::filesystem::path& yaml_file);

struct MapWithOrigin {
  MapImage image{};
  Eigen::Vector2d origin_m{Eigen::Vector2d::Zero()};  ///< lower left corner of the image, map frame
};

/// Like read_map(), with the first two numbers of `origin` [m], or (0, 0) without that key.
/// @throws SetupError as above.
MapWithOrigin read_map_with_origin(const std::filesystem::path& yaml_file);

}  // namespace waymark::evaluate
