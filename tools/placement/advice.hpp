// SPDX-License-Identifier: BSD-3-Clause
// The fewest new markers that bring the pose's standard deviation under a target.
#pragma once

#include "placement/covariance_model.hpp"
#include "placement/wall_places.hpp"

#include <span>
#include <vector>

namespace waymark::placement {

/// Consecutive steps whose sigma is above the target.
struct Stretch {
  std::size_t first{0};
  std::size_t last{0};
  double worst_m{0.0};
};

std::vector<Stretch> stretches_above(std::span<const double> sigmas_m, double target_m);

/// Places of a wall that is full of markers: some metres apart, of each wall.
std::vector<std::size_t> everywhere(std::span<const WallPlace> places);

struct Advice {
  std::vector<std::size_t> chosen{};    ///< of the places, in the order to hang them
  std::vector<double> worst_after_m{};  ///< with the places up to each
  std::vector<double> now_m{};          ///< sigma by step, with the markers that hang
  std::vector<double> then_m{};         ///< the same with the chosen ones
  /// Where even a marker at every place leaves more than the target, by step; else the target.
  std::vector<double> reachable_m{};
};

/// Largest; 0 of none.
double worst(std::span<const double> sigmas_m);

/// Those that hang, and those at chosen places.
std::vector<const Sightings*> hung_and(std::span<const Sightings> hung,
                                       std::span<const Sightings> at_places,
                                       std::span<const std::size_t> chosen);

/// Greedy on the excess of variance over the target, integrated along the way; lazily, for a place
/// seldom gains by others (Minoux 1978). Then those go that are not needed.
/// @param hung    sightings of the markers that hang.
/// @param places  with the sightings of a marker at each; plates of chosen ones do not overlap.
/// @param most    markers at the most: free ids.
Advice advise(const CovarianceModel& model, std::span<const Step> steps,
              std::span<const Sightings> hung, std::span<const WallPlace> places,
              std::span<const Sightings> at_places, double plate_m, double target_m,
              std::size_t most);

}  // namespace waymark::placement
