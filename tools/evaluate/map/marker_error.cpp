// SPDX-License-Identifier: BSD-3-Clause
#include "evaluate/map/marker_error.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
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

// Values of column `state`; as in lcmtypes/marker_landmark_t.lcm.
constexpr double kStateTentative = 2.0;
constexpr double kStateMoved = 3.0;

bool has_state(const std::filesystem::path& file) {
  const std::vector<std::string> lines = read_lines(file);
  return !lines.empty() && (lines.front() + ",").find(",state,") != std::string::npos;
}

Marker marker_of(const CsvTable& table, const std::vector<double>& row) {
  return {
      .id = static_cast<int>(std::lround(table.at(row, "id"))),
      .parent_from_marker = {table.at(row, "x_m"), table.at(row, "y_m"), table.at(row, "yaw_rad")},
      .instance = static_cast<int>(std::lround(table.at(row, "instance")))};
}

/// nullopt if no marker was moved and none is reported as moved.
std::optional<double> moved_named_share(const std::vector<Marker>& in_map,
                                        const std::vector<Marker>& in_world) {
  std::map<int, int> moved;  // by id
  std::map<int, int> named;
  for (const Marker& marker : in_world)
    moved[marker.id] += marker.has_moved ? 1 : 0;
  for (const Marker& marker : in_map)
    named[marker.id] += marker.has_moved ? 1 : 0;
  int both = 0;
  int either = 0;
  for (const auto& [id, count] : moved) {
    both += std::min(count, named[id]);
    either += std::max(count, named[id]);
  }
  for (const auto& [id, count] : named)
    either += moved.count(id) == 0 ? count : 0;
  if (either == 0) return std::nullopt;
  return static_cast<double>(both) / static_cast<double>(either);
}

}  // namespace

std::vector<Marker> read_markers(const std::filesystem::path& file, SkippedLines& skipped) {
  std::vector<std::string> columns{"id", "instance", "x_m", "y_m", "yaw_rad"};
  const bool with_state = has_state(file);
  if (with_state) columns.emplace_back("state");
  const CsvTable table = read_csv(file, columns, skipped);
  std::vector<Marker> markers;
  for (const auto& row : table.rows) {
    markers.push_back(marker_of(table, row));
    if (!with_state) continue;
    markers.back().has_moved = table.at(row, "state") == kStateMoved;
    markers.back().is_tentative = table.at(row, "state") == kStateTentative;
  }
  return markers;
}

std::vector<Marker> with_moves(std::vector<Marker> markers, const std::filesystem::path& file,
                               SkippedLines& skipped) {
  const CsvTable table = read_csv(file, {"id", "instance", "x_m", "y_m", "yaw_rad"}, skipped);
  for (const auto& row : table.rows) {
    Marker moved = marker_of(table, row);
    moved.has_moved = true;
    for (Marker& marker : markers) {
      if (marker.id == moved.id && marker.instance == moved.instance) marker = moved;
    }
  }
  return markers;
}

MarkerError marker_error(const std::vector<Marker>& estimated, const std::vector<Marker>& in_world,
                         const Se2& world_from_map, double gate_m) {
  std::vector<Marker> in_map;
  std::copy_if(estimated.begin(), estimated.end(), std::back_inserter(in_map),
               [](const Marker& marker) { return !marker.is_tentative; });
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

  MarkerError error{.tentative = estimated.size() - in_map.size()};
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
  error.moved_named_share = moved_named_share(in_map, in_world);
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
