// SPDX-License-Identifier: BSD-3-Clause
// Writes an imported log: LOG.lcm with LIDAR, ODOMETRY and CAMERA, beside it robot.toml and, if the
// log has reference poses, reference.tum.
#pragma once

#include "import/log/imported_log.hpp"

#include <filesystem>
#include <string>

namespace waymark {

/// Events are ordered by (time, channel), log time = message time. Every file is written completely
/// or not at all. An existing log is not replaced, nor are existing files beside it that differ.
/// @throws SetupError when the output cannot be written or the robot's configuration is invalid.
void write_imported_log(const ImportedLog& log, const ImportReport& report,
                        const std::filesystem::path& out);

/// Human-readable summary of the import, several lines.
std::string summary(const ImportedLog& log, const ImportReport& report);

}  // namespace waymark
