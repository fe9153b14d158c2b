// SPDX-License-Identifier: BSD-3-Clause
// Chooses few new markers that bring the standard deviation of the position below a target (greedy:
// not always the fewest possible).
#pragma once

#include "placement/covariance_model.hpp"
#include "placement/wall_places.hpp"

#include <functional>
#include <span>
#include <string>
#include <vector>

namespace waymark::placement {

/// Consecutive steps whose sigma is above the target; indices of steps, both inclusive.
struct Stretch {
  std::size_t first{0};
  std::size_t last{0};
  double worst_m{0.0};
};

std::vector<Stretch> stretches_above(std::span<const double> sigmas_m, double target_m);

/// Places about every 2 m along every wall, as indices of `places`.
std::vector<std::size_t> everywhere(std::span<const WallPlace> places);

struct Advice {
  std::vector<std::size_t> chosen{};    ///< indices of the places, in the order to add them
  std::vector<double> worst_after_m{};  ///< largest sigma with the first i + 1 chosen places
  std::vector<double> now_m{};          ///< sigma by step, with the existing markers
  std::vector<double> then_m{};         ///< sigma by step, also with markers at the chosen places
  /// By step: the target or, where even markers everywhere do not meet it, 1.02 times the sigma
  /// that they reach.
  std::vector<double> aims_m{};
  double everywhere_m{0.0};  ///< worst sigma with markers everywhere; 0 if the target is met now
};

/// The largest sigma; 0 if there are none.
double worst(std::span<const double> sigmas_m);

/// Sightings of the existing markers and of those at the chosen places.
std::vector<const Sightings*> hung_and(std::span<const Sightings> hung,
                                       std::span<const Sightings> at_places,
                                       std::span<const std::size_t> chosen);

/// Reports progress in one sentence.
using Report = std::function<void(const std::string&)>;

/// Greedy: adds the place that most reduces the variance above the target, integrated along the
/// path; finally removes places that are not needed. Evaluations are lazy (Minoux 1978), as another
/// place seldom increases the gain of a place.
/// @param hung       sightings of the existing markers.
/// @param at_places  sightings of a marker at each of `places`.
/// @param plate_m    side of a marker with its quiet zone; chosen plates do not overlap.
/// @param target_m   standard deviation wanted at every step.
/// @param most       largest number of new markers.
/// @param report     called for every new marker.
Advice advise(const CovarianceModel& model, std::span<const Step> steps,
              std::span<const Sightings> hung, std::span<const WallPlace> places,
              std::span<const Sightings> at_places, double plate_m, double target_m,
              std::size_t most, const Report& report);

}  // namespace waymark::placement
