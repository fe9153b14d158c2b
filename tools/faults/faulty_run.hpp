// SPDX-License-Identifier: BSD-3-Clause
// Copies the folder of a recorded run, with faults in its messages.
#pragma once

#include "faults/fault_config.hpp"

#include <array>
#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <string_view>

namespace waymark::faults {

/// File with the applied variant; marks a run as faulty.
inline constexpr std::string_view kMark = "variant_applied.toml";

/// All files that may be written.
inline constexpr std::array<std::string_view, 8> kFiles{kMark,
                                                        "scenario.toml",
                                                        "robot.toml",
                                                        "expect.toml",
                                                        "truth.tum",
                                                        "truth_markers.csv",
                                                        "truth_marker_moves.csv",
                                                        "run.lcm"};

/// Writes the mark; copies scenario.toml, robot.toml, truth.tum, truth_marker_moves.csv and
/// truth_markers.csv (with the new ids), as far as they exist; writes expect.toml and, last,
/// run.lcm, without the messages of slam. Seed of the faults: the scenario's run.seed, else 1.
/// @return how often each fault was injected.
/// @throws SetupError when run_dir holds no run or one that has faults already, when run_dir is
/// out_dir, when out_dir holds a recorded run without faults, or replays of another drive or other
/// faults, or when none of the variant's faults affects the log.
/// @throws std::runtime_error naming a file that cannot be read or written, or when ids are changed
/// in a run with moved markers.
std::map<std::string, std::int64_t> write_faulty_run(const std::filesystem::path& run_dir,
                                                     const Variant& variant,
                                                     const std::filesystem::path& out_dir);

/// truth_markers.csv with the new ids; instances count equal ids.
/// @throws std::runtime_error with file and line of a line without an id.
std::string renamed_markers(const std::string& csv, const FaultConfig& faults,
                            const std::filesystem::path& file);

}  // namespace waymark::faults
