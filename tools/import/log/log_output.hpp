// SPDX-License-Identifier: BSD-3-Clause
// An imported log in our form: LOG.lcm with LIDAR and ODOMETRY, beside it robot.toml and, where the
// log gives reference poses, reference.tum.
#pragma once

#include "import/log/imported_log.hpp"

#include <filesystem>
#include <string>

namespace waymark {

/// Events ordered by (time, channel), log time = message time. Every file is written whole or not
/// at all. A log that is there is not replaced, nor is what lies beside it by anything else.
/// @throws SetupError when the output cannot be written or the robot's configuration is invalid.
void write_imported_log(const ImportedLog& log, const ImportReport& report,
                        const std::filesystem::path& out);

/// What was imported, for people: one fact per line.
std::string summary(const ImportedLog& log, const ImportReport& report);

}  // namespace waymark
