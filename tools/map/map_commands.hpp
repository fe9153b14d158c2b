// SPDX-License-Identifier: BSD-3-Clause
// What waymark-map does with map files. All throw SetupError for files that are no maps, and for
// maps that do not fit together.
#pragma once

#include "common/geometry/se2.hpp"

#include <filesystem>
#include <string>

namespace waymark {

/// What a map is, for people, or as one JSON object.
std::string map_info(const std::filesystem::path& file, bool as_json);

/// Writes map.pgm, map.yaml, map.png, markers.csv (by the viewer) and graph.g2o into a folder.
void export_map(const std::filesystem::path& file, const std::filesystem::path& folder);

/// @return a sentence about the result.
std::string transform_map(const std::filesystem::path& file, const Se2& new_from_old,
                          const std::string& frame, const std::filesystem::path& out);

/// @return a sentence about the result.
std::string merge_maps(const std::filesystem::path& a, const std::filesystem::path& b,
                       const std::filesystem::path& out);

}  // namespace waymark
