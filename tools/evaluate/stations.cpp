// SPDX-License-Identifier: BSD-3-Clause
#include "evaluate/stations.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace waymark::evaluate {
namespace {

constexpr double kSpacing_m = 1.0;
/// Stands for "none" in the file, where every column is a finite number; no such value is negative.
constexpr double kNone = -1.0;

std::optional<double> some(double number) {
  return number < 0.0 ? std::nullopt : std::optional{number};
}

Station station_at(double travel_m, const PosePair& pair, const StampedCovariance* stamped,
                   const Se2& world_from_map) {
  const Se2 truth_from_estimate =
      pair.world_from_truth.inverse() * (world_from_map * pair.map_from_estimate);
  Station station{.travel_m = travel_m,
                  .t_s = pair.t_s,
                  .along_m = truth_from_estimate.x(),
                  .across_m = truth_from_estimate.y(),
                  .heading_rad = truth_from_estimate.theta()};
  if (stamped == nullptr) return station;
  station.health = stamped->health;
  station.nees = nees_of(pair, stamped->covariance, world_from_map);
  const double heading = pair.map_from_estimate.theta();
  const Eigen::Vector2d ahead{std::cos(heading), std::sin(heading)};
  const double variance = ahead.dot(stamped->covariance.topLeftCorner<2, 2>() * ahead);
  station.sigma_along_m = std::sqrt(std::max(variance, 0.0));
  return station;
}

}  // namespace

std::vector<Station> stations(const std::vector<PosePair>& pairs,
                              const std::vector<StampedCovariance>& covariances,
                              const Se2& world_from_map) {
  std::vector<Station> found;
  double travelled_m = 0.0;
  double next_m = kSpacing_m;
  for (std::size_t i = 1; i < pairs.size(); ++i) {
    const double step_m =
        (pairs[i].world_from_truth.translation() - pairs[i - 1].world_from_truth.translation())
            .norm();
    if (step_m < kLifted_m) travelled_m += step_m;
    if (travelled_m < next_m) continue;
    found.push_back(
        station_at(next_m, pairs[i], covariance_at(covariances, pairs[i].t_s), world_from_map));
    next_m += kSpacing_m;
  }
  return found;
}

std::string stations_csv(const std::vector<Station>& stations) {
  std::string text = "travel_m,t,along_m,across_m,heading_rad,nees,sigma_along_m,health\n";
  for (const Station& station : stations)
    text += fmt::format("{:.0f},{:.6f},{:.6f},{:.6f},{:.7f},{:.4f},{:.6f},{}\n", station.travel_m,
                        station.t_s, station.along_m, station.across_m, station.heading_rad,
                        station.nees.value_or(kNone), station.sigma_along_m.value_or(kNone),
                        static_cast<int>(station.health));
  return text;
}

std::vector<Station> read_stations(const std::filesystem::path& file, Skipped& skipped) {
  const CsvTable table = read_csv(
      file,
      {"travel_m", "t", "along_m", "across_m", "heading_rad", "nees", "sigma_along_m", "health"},
      skipped);
  std::vector<Station> stations;
  for (const auto& row : table.rows)
    stations.push_back({.travel_m = table.at(row, "travel_m"),
                        .t_s = table.at(row, "t"),
                        .along_m = table.at(row, "along_m"),
                        .across_m = table.at(row, "across_m"),
                        .heading_rad = table.at(row, "heading_rad"),
                        .nees = some(table.at(row, "nees")),
                        .sigma_along_m = some(table.at(row, "sigma_along_m")),
                        .health = static_cast<Health>(std::lround(table.at(row, "health")))});
  return stations;
}

}  // namespace waymark::evaluate
