// SPDX-License-Identifier: BSD-3-Clause
// Whether the map that a run has loaded is in the frame of the map that another run made.
#pragma once

#include "evaluate/map/marker_error.hpp"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace waymark::evaluate {

/// What both are compared by: a map file has an id of its own, which the run that made it does not
/// record, but a loaded map's markers stay where the file has them.
/// @param used    markers of the run that has loaded a map.
/// @param made    markers at the end of the run that made it.
/// @return what is wrong, as a clause about the loaded map; nullopt where most markers that both
///         have are at one place, or one of the two has no markers at all.
std::optional<std::string> difference_of(const std::vector<Marker>& used,
                                         const std::vector<Marker>& made);

/// Compares with each estimator of the mapping run that has markers.
/// @param used_file  markers.csv of the run that has loaded a map; need not exist.
/// @return a sentence if no estimator's map fits; else nullopt.
std::optional<std::string> foreign_map(const std::filesystem::path& used_file,
                                       const std::filesystem::path& mapping_run,
                                       SkippedLines& skipped);

}  // namespace waymark::evaluate
