// SPDX-License-Identifier: BSD-3-Clause
// Surveyed markers as CSV: the columns of markers.csv, so that a run's markers are the next run's
// survey.
#pragma once

#include "slam/core/landmark/surveyed_marker.hpp"

#include <filesystem>
#include <string>
#include <vector>

namespace waymark {

/// Columns id, x_m, y_m, sigma_x_m, sigma_y_m, and, where the direction is known, yaw_rad and
/// sigma_yaw_rad; others are left alone. Lines that are empty or begin with # are comments.
/// @param dictionary  of the markers, by its name.
/// @throws SetupError  in one sentence with file and line: not there, a column missing, no number,
/// an id twice or outside of the dictionary, a sigma below 1e-6 or above 1e6, fewer markers than
/// define a frame (two, or one with yaw).
std::vector<SurveyedMarker> read_survey(const std::filesystem::path& file,
                                        const std::string& dictionary);

}  // namespace waymark
