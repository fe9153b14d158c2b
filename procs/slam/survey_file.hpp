// SPDX-License-Identifier: BSD-3-Clause
// Surveyed markers as CSV, with the columns of markers.csv: the markers of a run can be the next
// run's survey.
#pragma once

#include "slam/core/landmark/surveyed_marker.hpp"

#include <filesystem>
#include <string>
#include <vector>

namespace waymark {

/// Columns id, x_m, y_m, sigma_x_m, sigma_y_m, and, where the direction is known, yaw_rad and
/// sigma_yaw_rad; others are ignored. Empty lines and lines that begin with # are skipped.
/// @param dictionary  name of the markers' dictionary.
/// @throws SetupError  in one sentence with file and line: no file, a missing column, not a number,
///                     an id that is repeated or outside of the dictionary, a sigma outside of
///                     kSigmaRange, fewer markers than define a frame (two, or one with yaw).
std::vector<SurveyedMarker> read_survey(const std::filesystem::path& file,
                                        const std::string& dictionary);

}  // namespace waymark
