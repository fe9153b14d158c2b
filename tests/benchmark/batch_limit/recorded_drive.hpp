// SPDX-License-Identifier: BSD-3-Clause
// What a log says of a drive, without the truth: motions, walls and markers at every stop that is
// to be solved for.
#pragma once

#include "batch_limit/wall_lines.hpp"
#include "slam/core/landmark/marker_measurement.hpp"
#include "slam/slam_config.hpp"

#include <cstdint>
#include <filesystem>
#include <vector>

namespace waymark::benchmark {

/// A pose to solve for.
struct Stop {
  Timestamp time{};
  Motion motion{};  ///< since the stop before
  std::vector<LineOfScan> lines{};
  std::vector<MarkerMeasurement> markers{};  ///< by the camera alone
};

inline constexpr double kStopDistance_m = 0.1;
inline constexpr double kStopTurn_rad = 0.0873;

struct RecordedDrive {
  std::vector<Stop> stops{};
  std::int64_t skipped_bytes{0};  ///< of a damaged log
};

/// Stops at the first scan, after every kStopDistance_m or kStopTurn_rad, and at the last scan.
/// @throws std::runtime_error if the log cannot be read or holds no scan that odometry covers.
RecordedDrive recorded_drive(const std::filesystem::path& log, const SlamConfig& config);

}  // namespace waymark::benchmark
