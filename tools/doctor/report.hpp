// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "doctor/doctor.hpp"

#include <filesystem>
#include <string>

namespace waymark {

/// One line per check, the remedy below it, and a line that counts the verdicts.
std::string to_text(const std::vector<Check>& checks);

/// One object: "checks" in order, each with name, verdict, value, finding, remedy; "channels", each
/// with messages, bytes, largest_bytes.
std::string to_json(const Diagnosis& diagnosis, const DoctorInput& input);

/// robot.toml with the corrections, and the findings as comments.
std::string to_robot_toml(const Diagnosis& diagnosis, const std::filesystem::path& log);

bool any_failed(const std::vector<Check>& checks);

}  // namespace waymark
