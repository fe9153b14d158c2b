// SPDX-License-Identifier: BSD-3-Clause
// Examines a log's LiDAR and odometry by its scans.
#pragma once

#include "import/log/imported_log.hpp"

namespace waymark {

/// What to do with odometry that counts backing up as forward driving.
enum class ReversedOdometry { kReport, kCorrect };

/// All checks of a log by its scans (README.md, "Findings"): estimates the noise of the ranges,
/// repairs breaks of the odometry, and reports everything found as notes.
/// @param log  after make_consistent().
void examine(ImportedLog& log, ReversedOdometry reversed, ImportReport& report);

}  // namespace waymark
