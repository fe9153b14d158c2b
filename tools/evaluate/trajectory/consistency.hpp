// SPDX-License-Identifier: BSD-3-Clause
// Consistency of covariances over many runs: mean NEES at each station, with its 95 % band.
#pragma once

#include "evaluate/trajectory/stations.hpp"

#include <cstddef>
#include <vector>

namespace waymark::evaluate {

/// Quantile of the chi-square distribution, accurate to 0.5 % from 15 degrees of freedom (5 runs)
/// on. Source: Wilson and Hilferty (1931).
/// @param normal_quantile  that of the standard normal distribution for the same probability.
double chi_square_quantile(double degrees_of_freedom, double normal_quantile);

/// One station over all runs that reached it.
struct StationConsistency {
  double travel_m{};
  std::size_t runs{};  ///< number of runs with a covariance at this station
  double mean_nees{};
  double band_low{};  ///< with consistent covariances, 95 % of the means are in the band
  double band_high{};
  double rms_along_m{};
  double rms_heading_rad{};

  bool in_band() const { return mean_nees >= band_low && mean_nees <= band_high; }
};

/// In order of travel. Stations without any covariance are left out.
std::vector<StationConsistency> consistency(const std::vector<std::vector<Station>>& runs);

/// Mean of error^2 / variance over all stations and runs, per axis: 1 if consistent, below 1 if the
/// covariances are too large. NaN without a covariance.
struct NeesPerAxis {
  double along{};
  double across{};
  double heading{};
};

NeesPerAxis nees_per_axis(const std::vector<std::vector<Station>>& runs);

/// Stations of single runs that have no usable covariance, and are left out of the means above.
std::size_t count_without_covariance(const std::vector<std::vector<Station>>& runs);

/// Share of the stations whose mean NEES is in its band; NaN without stations.
double share_in_band(const std::vector<StationConsistency>& stations);

}  // namespace waymark::evaluate
