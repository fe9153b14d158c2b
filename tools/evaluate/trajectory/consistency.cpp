// SPDX-License-Identifier: BSD-3-Clause
#include "evaluate/trajectory/consistency.hpp"

#include <cmath>
#include <limits>
#include <map>

namespace waymark::evaluate {
namespace {

constexpr double kDegreesOfFreedom = 3.0;    // x, y, heading
constexpr double kNormalQuantile = 1.95996;  // 97.5 %

struct Sums {
  std::size_t runs{0};
  double nees{0.0};
  double along_squared{0.0};
  double heading_squared{0.0};
};

bool has_covariance(const Station& station) {
  return station.nees && station.sigma_along_m.value_or(0.0) > 0.0 &&
         station.sigma_across_m.value_or(0.0) > 0.0 &&
         station.sigma_heading_rad.value_or(0.0) > 0.0;
}

}  // namespace

double chi_square_quantile(double degrees_of_freedom, double normal_quantile) {
  const double a = 2.0 / (9.0 * degrees_of_freedom);
  const double root = 1.0 - a + normal_quantile * std::sqrt(a);
  return degrees_of_freedom * root * root * root;
}

std::vector<StationConsistency> consistency(const std::vector<std::vector<Station>>& runs) {
  std::map<double, Sums> sums_at;
  for (const std::vector<Station>& run : runs) {
    for (const Station& station : run) {
      if (!station.nees) continue;
      Sums& sums = sums_at[station.travel_m];
      ++sums.runs;
      sums.nees += *station.nees;
      sums.along_squared += station.along_m * station.along_m;
      sums.heading_squared += station.heading_rad * station.heading_rad;
    }
  }
  std::vector<StationConsistency> stations;
  for (const auto& [travel_m, sums] : sums_at) {
    const auto count = static_cast<double>(sums.runs);
    const double freedom = kDegreesOfFreedom * count;
    stations.push_back({.travel_m = travel_m,
                        .runs = sums.runs,
                        .mean_nees = sums.nees / count,
                        .band_low = chi_square_quantile(freedom, -kNormalQuantile) / count,
                        .band_high = chi_square_quantile(freedom, kNormalQuantile) / count,
                        .rms_along_m = std::sqrt(sums.along_squared / count),
                        .rms_heading_rad = std::sqrt(sums.heading_squared / count)});
  }
  return stations;
}

NeesPerAxis nees_per_axis(const std::vector<std::vector<Station>>& runs) {
  NeesPerAxis sums;
  double count = 0.0;
  const auto ratio = [](double error, const std::optional<double>& sigma) {
    return error * error / (sigma.value() * sigma.value());
  };
  for (const std::vector<Station>& run : runs) {
    for (const Station& station : run) {
      if (!has_covariance(station)) continue;
      sums.along += ratio(station.along_m, station.sigma_along_m);
      sums.across += ratio(station.across_m, station.sigma_across_m);
      sums.heading += ratio(station.heading_rad, station.sigma_heading_rad);
      count += 1.0;
    }
  }
  return {sums.along / count, sums.across / count, sums.heading / count};
}

std::size_t count_without_covariance(const std::vector<std::vector<Station>>& runs) {
  std::size_t count = 0;
  for (const std::vector<Station>& run : runs) {
    for (const Station& station : run)
      count += has_covariance(station) ? 0U : 1U;
  }
  return count;
}

double share_in_band(const std::vector<StationConsistency>& stations) {
  if (stations.empty()) return std::numeric_limits<double>::quiet_NaN();
  double in_band = 0.0;
  for (const StationConsistency& station : stations)
    in_band += station.in_band() ? 1.0 : 0.0;
  return in_band / static_cast<double>(stations.size());
}

}  // namespace waymark::evaluate
