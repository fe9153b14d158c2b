// SPDX-License-Identifier: BSD-3-Clause
#include "placement/placement_input.hpp"

#include "common/geometry/median.hpp"
#include "common/log/log_file.hpp"
#include "common/messages/codec.hpp"
#include "evaluate/files/map_image.hpp"
#include "evaluate/files/tum.hpp"
#include "evaluate/run/run_evaluation.hpp"
#include "slam/map_file.hpp"
#include "viewer/core/scene/grid_map.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace waymark::placement {
namespace {

namespace fs = std::filesystem;

constexpr double kLongestStep_m = 1.0;  // between poses; a longer step is a gap, not driving

PlacedMapImage image_in(const fs::path& yaml_file) {
  evaluate::MapWithOrigin map = evaluate::read_map_with_origin(yaml_file);
  return {std::move(map.image), map.origin_m};
}

PlacedMapImage image_of(const GridMap& grid) {
  constexpr viewer::MapThresholds kThresholds;  // as for map.pgm
  std::vector<std::pair<CellIndex, Cell>> known;
  grid.occupancy.for_each_tile([&](TileIndex index, const auto& cells) {
    for (std::size_t offset = 0; offset < kTileCells; ++offset) {
      if (!cells[offset].is_mapped()) continue;
      const double occupancy = cells[offset].occupancy();
      known.emplace_back(cell_at(index, offset), occupancy >= kThresholds.occupied ? Cell::kOccupied
                                                 : occupancy <= kThresholds.free   ? Cell::kFree
                                                                                 : Cell::kUnknown);
    }
  });
  if (known.empty()) return {};
  CellIndex least = known.front().first;
  CellIndex most = least;
  for (const auto& [cell, state] : known) {
    least = {std::min(least.x, cell.x), std::min(least.y, cell.y)};
    most = {std::max(most.x, cell.x), std::max(most.y, cell.y)};
  }
  PlacedMapImage image;
  image.width_px = most.x - least.x + 1;
  image.height_px = most.y - least.y + 1;
  image.resolution_m = grid.frame.resolution_m;
  image.origin_m =
      grid.frame.origin_m + grid.frame.resolution_m * Eigen::Vector2d{least.x, least.y};
  image.cells.resize(static_cast<std::size_t>(image.width_px) * image.height_px);
  for (const auto& [cell, state] : known)
    image.cells[static_cast<std::size_t>(cell.y - least.y) * image.width_px + (cell.x - least.x)] =
        state;
  return image;
}

/// The run itself if it is a row; else its row `waymark`, or its only row.
fs::path row_in(const fs::path& run) {
  if (fs::exists(run / "trajectory.tum")) return run;
  if (fs::exists(run / "waymark" / "trajectory.tum")) return run / "waymark";
  const std::vector<std::string> rows = evaluate::estimators_in(run);
  if (rows.size() == 1) return run / rows.front();
  if (rows.empty())
    throw SetupError{run.string() + ": neither a run nor a row: no trajectory.tum in it"};
  throw SetupError{fmt::format("{}: several rows, none of them 'waymark'; give one of {}",
                               run.string(), fmt::join(rows, ", "))};
}

void check_is_mapping(const PlacementInput& input) {
  const SlamSection& slam = input.config.slam;
  if (slam.estimator != EstimatorName::kWaymark)
    throw SetupError{input.source.string() +
                     ": not by the estimator 'waymark', whose covariances are what is predicted"};
  if (slam.mode != MapMode::kMap || !input.config.robot.markers.survey_file.empty())
    throw SetupError{input.source.string() +
                     ": it was localised in a map or a survey; give the run or the map file that "
                     "mapped the place"};
}

/// Replaces the values whose keys are in the file.
void overlay(const fs::path& file, SlamConfig& config) {
  const auto problems =
      config_detail::read_part(file, [&config](Fields& fields) { config.describe(fields); });
  if (!problems.empty()) throw ConfigError{problems};
}

/// Median height of the markers that the detector measured [m]; the base frame is on the floor.
std::optional<double> marker_height_in(const fs::path& log) {
  std::vector<double> heights_m;
  LogReader reader{log};
  const auto is_wanted = [](std::string_view channel) {
    return channel == channels::kMarkers.name;
  };
  while (const auto message = reader.next(is_wanted)) {
    const auto decoded = decode<marker_detections_t>(message->payload);
    if (!decoded.message) continue;
    for (const marker_detection_t& marker : decoded.message->detections)
      heights_m.push_back(marker.position_m[2]);
  }
  if (heights_m.empty()) return std::nullopt;
  return upper_median(std::move(heights_m));
}

/// Height of the markers in the log of the row's detector, or in that of the run.
std::optional<double> marker_height_of(const fs::path& row) {
  for (const fs::path& log : {row / "markers.lcm", row.parent_path() / "run.lcm"})
    if (fs::exists(log))
      if (const auto height_m = marker_height_in(log)) return height_m;
  return std::nullopt;
}

void read_row(const fs::path& config, PlacementInput& input) {
  const fs::path& row = input.source;
  const fs::path own = row / "config.toml";
  if (config.empty() && !fs::exists(own))
    throw SetupError{row.string() + ": no config.toml in it; give the robot with --config"};
  if (fs::exists(own)) input.config = load_part<SlamConfig>(own);
  if (!config.empty()) overlay(config, input.config);
  check_is_mapping(input);
  evaluate::SkippedLines skipped;
  const fs::path final_trajectory = row / "trajectory_final.tum";
  const auto trajectory = evaluate::read_tum(
      fs::exists(final_trajectory) ? final_trajectory : row / "trajectory.tum", skipped);
  for (const evaluate::StampedPose& pose : trajectory)
    input.places.push_back({pose.t_s, pose.parent_from_base});
  if (fs::exists(row / "markers.csv")) {
    const auto table = evaluate::read_csv(row / "markers.csv",
                                          {"id", "instance", "x_m", "y_m", "yaw_rad"}, skipped);
    for (const auto& line : table.rows)
      input.markers.push_back(
          {static_cast<int>(std::lround(table.at(line, "id"))),
           static_cast<int>(std::lround(table.at(line, "instance"))),
           {table.at(line, "x_m"), table.at(line, "y_m"), table.at(line, "yaw_rad")}});
  }
  if (fs::exists(row / "covariance.csv"))
    input.covariances = evaluate::read_covariances(row / "covariance.csv", skipped);
  input.image = image_in(row / "map.yaml");
  input.marker_height_m = marker_height_of(fs::canonical(row));
  input.notes.insert(input.notes.end(), skipped.begin(), skipped.end());
}

void read_map_source(const fs::path& config, PlacementInput& input) {
  const MapFile file = read_map_file(input.source);
  if (file.map.parent_map_id != 0)
    throw SetupError{input.source.string() +
                     ": extends another map, so it holds no single drive; give the first map"};
  if (config.empty())
    input.notes.emplace_back(
        "a map file does not say with which robot it was made: usual values; --config robot.toml");
  else
    input.config = load_part<SlamConfig>(config);
  check_is_mapping(input);
  input.config.robot.markers.dictionary = file.info.marker_dictionary;
  input.config.robot.markers.size_m = file.info.marker_size_m;
  for (const Se2& pose : file.map.graph.poses)
    input.places.push_back({0.0, pose});
  for (const Landmark& landmark : file.map.landmarks)
    input.markers.push_back({landmark.id, landmark.instance, landmark.map_from_marker});
  input.image = image_of(file.map.grid);
}

}  // namespace

PlacementInput read_placement_input(const fs::path& source, const fs::path& config) {
  PlacementInput input;
  std::error_code ignored;
  if (!fs::exists(source, ignored)) {
    throw SetupError{source.string() +
                     ": is not there; give the folder of a run or of its row, or "
                     "a map file"};
  }
  if (fs::is_directory(source, ignored)) {
    input.source = row_in(source);
    read_row(config, input);
  } else {
    input.source = source;
    read_map_source(config, input);
  }
  if (input.places.size() < 2)
    throw SetupError{input.source.string() + ": fewer than two poses, so no drive"};
  for (std::size_t i = 1; i < input.places.size(); ++i) {
    const double step_m = (input.places[i].map_from_base.translation() -
                           input.places[i - 1].map_from_base.translation())
                              .norm();
    if (step_m > kLongestStep_m)
      throw SetupError{fmt::format(
          "{}: the trajectory jumps by {:.1f} m: the robot was carried, which no model predicts",
          input.source.string(), step_m)};
  }
  if (std::find(input.image.cells.begin(), input.image.cells.end(), Cell::kOccupied) ==
      input.image.cells.end())
    throw SetupError{input.source.string() + ": its map has no wall to hang a marker on"};
  return input;
}

}  // namespace waymark::placement
