// SPDX-License-Identifier: BSD-3-Clause
// The marker map of a filter, from those of its particles.
#pragma once

#include "slam/core/mapping/landmark_map.hpp"

#include <span>
#include <vector>

namespace waymark {

/// The markers of one particle, in order of their first sighting, and its weight (normalised).
struct WeighedLandmarks {
  std::vector<Landmark> markers{};
  double weight{0.0};
};

/// Weighted means of the markers that particle `best` knows, with the covariance of the mixture.
/// Particles meet markers in the same order unless they disagree about which one it is: those that
/// have another one there, or the same further than `same_within_m` away, are left out.
/// @return in order of (id, instance).
std::vector<Landmark> mean_landmarks(std::span<const WeighedLandmarks> particles, std::size_t best,
                                     double same_within_m);

}  // namespace waymark
