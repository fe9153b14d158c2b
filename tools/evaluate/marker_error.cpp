// SPDX-License-Identifier: BSD-3-Clause
#include "evaluate/marker_error.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace waymark::evaluate {
namespace {

struct Candidate {
  double distance_m{};
  std::size_t estimate{};
  std::size_t truth{};

  bool operator<(const Candidate& other) const {
    return std::tie(distance_m, estimate, truth) <
           std::tie(other.distance_m, other.estimate, other.truth);
  }
};

}  // namespace

std::vector<Marker> read_markers(const std::filesystem::path& file, Skipped& skipped) {
  const CsvTable table = read_csv(file, {"id", "instance", "x_m", "y_m", "yaw_rad"}, skipped);
  std::vector<Marker> markers;
  for (const auto& row : table.rows)
    markers.push_back({static_cast<int>(std::lround(table.at(row, "id"))),
                       Se2{table.at(row, "x_m"), table.at(row, "y_m"), table.at(row, "yaw_rad")}});
  return markers;
}

MarkerError marker_error(const std::vector<Marker>& in_map, const std::vector<Marker>& in_world,
                         const Se2& world_from_map, double gate_m) {
  std::vector<Candidate> candidates;
  for (std::size_t e = 0; e < in_map.size(); ++e) {
    const Eigen::Vector2d estimate = world_from_map * in_map[e].parent_from_marker.translation();
    for (std::size_t t = 0; t < in_world.size(); ++t) {
      const double distance_m = (estimate - in_world[t].parent_from_marker.translation()).norm();
      if (in_map[e].id == in_world[t].id && distance_m <= gate_m)
        candidates.push_back({distance_m, e, t});
    }
  }
  std::sort(candidates.begin(), candidates.end());

  MarkerError error{};
  double sum_m = 0.0;
  double sum_deg = 0.0;
  double max_m = 0.0;
  double max_deg = 0.0;
  double num_right = 0.0;
  std::vector<bool> estimate_taken(in_map.size(), false);
  std::vector<bool> truth_taken(in_world.size(), false);
  for (const auto& [distance_m, e, t] : candidates) {
    if (estimate_taken[e] || truth_taken[t]) continue;
    estimate_taken[e] = truth_taken[t] = true;
    const Se2 world_from_marker = world_from_map * in_map[e].parent_from_marker;
    const double turn_deg = std::abs(degrees(
        angle_difference(world_from_marker.theta(), in_world[t].parent_from_marker.theta())));
    sum_m += distance_m;
    sum_deg += turn_deg;
    max_m = std::max(max_m, distance_m);
    max_deg = std::max(max_deg, turn_deg);
    num_right += distance_m <= kRightMarker_m ? 1.0 : 0.0;
    ++error.matched;
  }
  error.missing = in_world.size() - error.matched;
  error.spurious = in_map.size() - error.matched;
  if (error.matched == 0) return error;
  error.right_share =
      num_right / static_cast<double>(error.matched + error.missing + error.spurious);
  const double count = static_cast<double>(error.matched);
  error.mean_position_m = sum_m / count;
  error.max_position_m = max_m;
  error.mean_yaw_deg = sum_deg / count;
  error.max_yaw_deg = max_deg;
  return error;
}

}  // namespace waymark::evaluate
