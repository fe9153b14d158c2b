// SPDX-License-Identifier: BSD-3-Clause
// Errors of an estimated trajectory relative to a reference.
#pragma once

#include "evaluate/files/tum.hpp"

#include <optional>
#include <string_view>
#include <vector>

namespace waymark::evaluate {

/// An estimated pose and the reference at its time, each in its own frame.
struct PosePair {
  double t_s{};
  Se2 map_from_estimate{};
  Se2 world_from_truth{};
};

/// Pairs each estimate within the reference's time span with the interpolated reference.
std::vector<PosePair> associate(const Trajectory& estimate, const Trajectory& truth);

enum class Alignment {
  kOrigin,  ///< first pose on first pose, where the map begins; for simulations
  kSe2,     ///< best rigid fit of the positions; for real logs
  kFrame    ///< no alignment: the map's frame in the world is known
};

std::string_view name_of(Alignment alignment);

/// world_from_map. @param pairs not empty. @param alignment not kFrame.
/// Source of the fit: Umeyama (1991) in the plane, without scale.
Se2 align(const std::vector<PosePair>& pairs, Alignment alignment);

/// Root mean square and largest absolute value.
struct Spread {
  double rms{};
  double max{};
};

inline std::optional<double> rms_of(const std::optional<Spread>& spread) {
  return spread ? std::optional{spread->rms} : std::nullopt;
}

struct TrajectoryError {
  Alignment alignment{};
  std::size_t poses{};
  double duration_s{};
  double ate_origin_m{};                ///< RMS distance after alignment on the first pose
  double ate_se2_m{};                   ///< RMS distance after the best rigid fit
  std::optional<double> ate_frame_m{};  ///< RMS distance in a known frame, without alignment
  // The errors below are after `alignment`, on which RPE does not depend.
  Spread distance_m{};
  std::optional<Spread> along_m{};   ///< along the line from the first to the last true pose
  std::optional<Spread> across_m{};  ///< absent if that line is shorter than a metre
  Spread heading_deg{};
  double end_distance_m{};
  double end_heading_deg{};
  std::size_t rpe_pairs{};  ///< pairs of poses a metre of true travel apart
  std::optional<Spread> rpe_translation_m{};
  std::optional<Spread> rpe_rotation_deg{};
};

/// @param pairs           not empty.
/// @param world_from_map  the map's frame if it is known; then used instead of `alignment`.
TrajectoryError trajectory_error(const std::vector<PosePair>& pairs, Alignment alignment,
                                 const std::optional<Se2>& world_from_map = std::nullopt);

}  // namespace waymark::evaluate
