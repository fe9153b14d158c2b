// SPDX-License-Identifier: BSD-3-Clause
// What a log's own scans say about its LiDAR and its odometry.
#pragma once

#include "import/log/imported_log.hpp"

namespace waymark {

enum class ReversedOdometry { kName, kMend };

/// Estimates the noise of the ranges; looks for odometry that stands still while the scans change,
/// and for odometry that counts backing up as forward driving, which is mended only on request.
/// Everything found is a note of the report.
/// @param log  complete
void examine(ImportedLog& log, ReversedOdometry reversed, ImportReport& report);

}  // namespace waymark
