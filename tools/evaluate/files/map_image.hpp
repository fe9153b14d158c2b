// SPDX-License-Identifier: BSD-3-Clause
// A ROS map_server map (PGM + YAML) as cells that are free, occupied or unknown.
#pragma once

#include "evaluate/files/text_file.hpp"

#include <cstdint>
#include <filesystem>
#include <vector>

namespace waymark::evaluate {

enum class Cell : std::uint8_t { kUnknown, kFree, kOccupied };

/// Cell (0, 0) is the lower left one; x runs right, y runs up, as in the map frame.
struct MapImage {
  int width_px{};
  int height_px{};
  double resolution_m{};
  std::vector<Cell> cells{};  ///< row by row, from the bottom

  bool contains(int x, int y) const { return x >= 0 && y >= 0 && x < width_px && y < height_px; }

  Cell at(int x, int y) const {
    return contains(x, y) ? cells[static_cast<std::size_t>(y) * width_px + x] : Cell::kUnknown;
  }
};

/// Reads map.yaml (`image`, `resolution`, `origin`, `negate`, `occupied_thresh`, `free_thresh`, one
/// `key: value` per line) and the binary 8-bit PGM it names, relative to its own folder.
/// @throws InputError naming file, line and what was expected.
MapImage read_map(const std::filesystem::path& yaml_file);

}  // namespace waymark::evaluate
