// SPDX-License-Identifier: BSD-3-Clause
// Health and jumps of the estimate over time, and its behaviour after a kidnap.
#pragma once

#include "evaluate/trajectory/nees.hpp"

#include <filesystem>
#include <optional>
#include <vector>

namespace waymark::evaluate {

/// What followed after the robot was first lifted. Durations count from `sighting_t_s` and are not
/// negative; nullopt = it never happened.
struct Kidnap {
  double lifted_t_s{};
  double sighting_t_s{};  ///< first frame with a marker from lifted_t_s on; if none: lifted_t_s
  std::optional<double> says_lost_s{};    ///< first health `lost`; 0 if before the sighting
  std::optional<double> found_again_s{};  ///< first pose that is right for at least a second
  /// Time after `sighting_t_s` with a pose that is wrong, not `lost`, and has a NEES > 16.3 or a
  /// singular covariance.
  double confident_wrong_s{};
};

struct HealthSummary {
  double share_tracking{};  ///< of the estimates with a known health
  double share_degenerate{};
  double share_lost{};
  double max_jump_m{};  ///< largest error of a step between two estimates, before a kidnap
  std::optional<Kidnap> kidnap{};
};

/// Times [s] of the frames that show a marker, from channel MARKERS of a log.
/// @throws SetupError if the log cannot be read.
std::vector<double> sighting_times(const std::filesystem::path& log);

/// Time at which the robot was first lifted [s]; nullopt if it never was.
std::optional<double> lifted_t_s(const Trajectory& truth);

/// @param pairs       not empty, in order of time.
/// @param sightings_s times of frames with a marker, in order; may be empty.
HealthSummary health_summary(const std::vector<PosePair>& pairs,
                             const std::vector<StampedCovariance>& covariances,
                             const Se2& world_from_map, std::optional<double> lifted_t_s,
                             const std::vector<double>& sightings_s);

}  // namespace waymark::evaluate
