// SPDX-License-Identifier: BSD-3-Clause
#include "evaluate/trajectory/stations.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace waymark::evaluate {
namespace {

constexpr double kSpacing_m = 1.0;
constexpr double kLifted_m = 0.3;     ///< a shorter step counts as driven, whatever its duration
constexpr double kFastest_mps = 1.0;  ///< twice the speed of the fastest scenario's robot
/// Written for nullopt, because every column has to be a finite number; valid values are not
/// negative.
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
  const Eigen::Matrix2d turn = pair.map_from_estimate.rotation();
  const Eigen::Matrix2d of_position =
      turn.transpose() * stamped->covariance.topLeftCorner<2, 2>() * turn;
  const auto sigma = [](double variance) {
    return std::sqrt(std::max(variance, 0.0));
  };
  station.sigma_along_m = sigma(of_position(0, 0));
  station.sigma_across_m = sigma(of_position(1, 1));
  station.sigma_heading_rad = sigma(stamped->covariance(2, 2));
  return station;
}

/// Travel of the true robot from one pose to the next [m]; 0 if it was lifted in between.
double step_m(const PosePair& before, const PosePair& after) {
  if (was_lifted(before.world_from_truth, after.world_from_truth, after.t_s - before.t_s))
    return 0.0;
  return (after.world_from_truth.translation() - before.world_from_truth.translation()).norm();
}

}  // namespace

bool was_lifted(const Se2& before, const Se2& after, double duration_s) {
  return (after.translation() - before.translation()).norm() >
         std::max(kLifted_m, kFastest_mps * duration_s);
}

double driven_m(const std::vector<PosePair>& pairs) {
  double sum_m = 0.0;
  for (std::size_t i = 1; i < pairs.size(); ++i)
    sum_m += step_m(pairs[i - 1], pairs[i]);
  return sum_m;
}

std::vector<Station> stations(const std::vector<PosePair>& pairs,
                              const std::vector<StampedCovariance>& covariances,
                              const Se2& world_from_map) {
  std::vector<Station> found;
  double travelled_m = 0.0;
  double next_m = kSpacing_m;
  for (std::size_t i = 1; i < pairs.size(); ++i) {
    travelled_m += step_m(pairs[i - 1], pairs[i]);
    if (travelled_m < next_m) continue;
    const double station_m = kSpacing_m * std::floor(travelled_m / kSpacing_m);
    found.push_back(
        station_at(station_m, pairs[i], covariance_at(covariances, pairs[i].t_s), world_from_map));
    next_m = station_m + kSpacing_m;
  }
  return found;
}

std::optional<double> sigma_growth(const std::vector<Station>& stations, double from_m,
                                   double to_m) {
  const auto sigma_at = [&](double travel_m) {
    const auto station = std::find_if(stations.begin(), stations.end(), [&](const Station& s) {
      return s.travel_m == std::floor(travel_m);
    });
    return station == stations.end() ? std::nullopt : station->sigma_along_m;
  };
  const std::optional<double> from = sigma_at(from_m);
  const std::optional<double> to = sigma_at(to_m);
  if (!from || !to || *from <= 0.0) return std::nullopt;
  return *to / *from;
}

std::string stations_csv(const std::vector<Station>& stations) {
  std::string text =
      "travel_m,t,along_m,across_m,heading_rad,nees,sigma_along_m,sigma_across_m,"
      "sigma_heading_rad,health\n";
  for (const Station& station : stations)
    text +=
        fmt::format("{:.0f},{:.6f},{:.6f},{:.6f},{:.7f},{:.4f},{:.6f},{:.6f},{:.7f},{}\n",
                    station.travel_m, station.t_s, station.along_m, station.across_m,
                    station.heading_rad, station.nees.value_or(kNone),
                    station.sigma_along_m.value_or(kNone), station.sigma_across_m.value_or(kNone),
                    station.sigma_heading_rad.value_or(kNone), static_cast<int>(station.health));
  return text;
}

std::vector<Station> read_stations(const std::filesystem::path& file, SkippedLines& skipped) {
  const CsvTable table =
      read_csv(file,
               {"travel_m", "t", "along_m", "across_m", "heading_rad", "nees", "sigma_along_m",
                "sigma_across_m", "sigma_heading_rad", "health"},
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
                        .sigma_across_m = some(table.at(row, "sigma_across_m")),
                        .sigma_heading_rad = some(table.at(row, "sigma_heading_rad")),
                        .health = static_cast<Health>(std::lround(table.at(row, "health")))});
  return stations;
}

}  // namespace waymark::evaluate
