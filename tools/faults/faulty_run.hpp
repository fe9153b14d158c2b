// SPDX-License-Identifier: BSD-3-Clause
// The folder of a recorded run -> another, of the same drive with faults in its messages.
#pragma once

#include "faults/fault_config.hpp"

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>

namespace waymark::faults {

/// Copies scenario.toml, robot.toml, truth.tum, truth_marker_moves.csv (if there) and
/// truth_markers.csv (with the ids that the markers now have), writes expect.toml and, last,
/// run.lcm. Random numbers: the scenario's run.seed.
/// @return how often each fault was put in.
/// @throws SetupError when run_dir holds no run, or is out_dir.
/// @throws std::runtime_error naming the file that cannot be read or written.
std::map<std::string, std::int64_t> write_faulty_run(const std::filesystem::path& run_dir,
                                                     const Variant& variant,
                                                     const std::filesystem::path& out_dir);

/// The lines of truth_markers.csv with new ids; instances count equal ids.
std::string renamed_markers(const std::string& csv, const FaultConfig& faults);

}  // namespace waymark::faults
