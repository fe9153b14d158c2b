// SPDX-License-Identifier: BSD-3-Clause
// Whether covariances are consistent over many runs: the mean NEES at each station
// against the band that chance allows.
#pragma once

#include "evaluate/trajectory/stations.hpp"

#include <cstddef>
#include <vector>

namespace waymark::evaluate {

/// Quantile of the chi-square distribution, to 0.5 % from 15 degrees of freedom
/// (5 runs) on.
/// Source: Wilson and Hilferty (1931).
/// @param normal_quantile  that of the standard normal distribution for the same probability.
double chi_square_quantile(double degrees_of_freedom, double normal_quantile);

/// One station over all runs that reached it.
struct StationConsistency {
  double travel_m{};
  std::size_t runs{};  ///< with a covariance there
  double mean_nees{};
  double band_low{};  ///< 95 % of the means are in the band if the covariances are right
  double band_high{};
  double rms_along_m{};
  double rms_heading_rad{};

  bool in_band() const { return mean_nees >= band_low && mean_nees <= band_high; }
};

/// By travel. Stations that no run reached with a covariance are left out.
std::vector<StationConsistency> consistency(const std::vector<std::vector<Station>>& runs);

/// Mean over all stations and runs of the squared error over its variance, axis by axis: 1 is
/// right, below it the covariance is too wide. NaN without a covariance.
struct SquaresOverVariances {
  double along{};
  double across{};
  double heading{};
};

SquaresOverVariances squares_over_variances(const std::vector<std::vector<Station>>& runs);

/// NaN without stations.
double share_in_band(const std::vector<StationConsistency>& stations);

}  // namespace waymark::evaluate
