// SPDX-License-Identifier: BSD-3-Clause
// What the estimator said of itself, and when: health, jumps, and what happened after a kidnap.
#pragma once

#include "evaluate/trajectory/nees.hpp"

#include <filesystem>
#include <optional>
#include <vector>

namespace waymark::evaluate {

/// After the first time that the robot was lifted and put down elsewhere. Times are seconds after
/// `sighting_t_s`; absent = it never happened.
struct Kidnap {
  double lifted_t_s{};
  double sighting_t_s{};  ///< first frame with a marker since; without a log, when it was lifted
  std::optional<double> says_lost_s{};    ///< 0 if it said so before
  std::optional<double> found_again_s{};  ///< pose right, and right for a second from then on
  double confident_wrong_s{};             ///< pose wrong and far outside the covariance, not `lost`
};

struct Timeline {
  double share_tracking{};  ///< of the estimates with a health
  double share_degenerate{};
  double share_lost{};
  double max_jump_m{};  ///< correction from one estimate to the next, but for relocalisations
  std::optional<Kidnap> kidnap{};
};

/// Times [s] of the frames that show a marker, from channel MARKERS of a log.
/// @throws InputError if the log cannot be read.
std::vector<double> sighting_times(const std::filesystem::path& log);

/// When the truth says that the robot was lifted.
std::optional<double> lifted_t_s(const Trajectory& truth);

/// @param pairs       not empty, in order of time.
/// @param sightings_s times of frames with a marker, in order; may be empty.
Timeline timeline(const std::vector<PosePair>& pairs,
                  const std::vector<StampedCovariance>& covariances, const Se2& world_from_map,
                  std::optional<double> lifted_t_s, const std::vector<double>& sightings_s);

}  // namespace waymark::evaluate
