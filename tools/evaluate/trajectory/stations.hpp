// SPDX-License-Identifier: BSD-3-Clause
// Errors sampled every metre of travel, at stations, so that runs can be compared.
#pragma once

#include "evaluate/trajectory/nees.hpp"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace waymark::evaluate {

/// Errors are estimate minus truth in the true base's frame: along = ahead, across = to the left.
struct Station {
  double travel_m{};  ///< distance driven by the true robot since the first pose; a whole number
  double t_s{};
  double along_m{};
  double across_m{};
  double heading_rad{};
  std::optional<double> nees{};  ///< 3 degrees of freedom; absent without a covariance
  std::optional<double> sigma_along_m{};
  std::optional<double> sigma_across_m{};
  std::optional<double> sigma_heading_rad{};
  Health health{Health::kUnknown};
};

/// True if the robot was lifted between two true poses: it is further away than it can drive.
bool was_lifted(const Se2& before, const Se2& after, double duration_s);

/// Length of the true trajectory [m], without steps in which the robot was lifted.
double driven_m(const std::vector<PosePair>& pairs);

/// One station for each metre of travel: the first pose at or after it; metres without a pose are
/// left out. Being lifted is no travel.
std::vector<Station> stations(const std::vector<PosePair>& pairs,
                              const std::vector<StampedCovariance>& covariances,
                              const Se2& world_from_map);

/// Ratio of sigma_along_m at `to_m` to that at `from_m`; nullopt if either is missing.
std::optional<double> sigma_growth(const std::vector<Station>& stations, double from_m,
                                   double to_m);

/// `travel_m,t,along_m,across_m,heading_rad,nees,sigma_along_m,sigma_across_m,sigma_heading_rad,health`;
/// -1 = none.
std::string stations_csv(const std::vector<Station>& stations);

/// @throws SetupError if the file cannot be read.
std::vector<Station> read_stations(const std::filesystem::path& file, SkippedLines& skipped);

}  // namespace waymark::evaluate
