// SPDX-License-Identifier: BSD-3-Clause
#include "slam/slam_inputs.hpp"

#include "common/log/log_file.hpp"
#include "common/logging/logging.hpp"
#include "slam/last_pose.hpp"
#include "slam/map_file.hpp"
#include "slam/survey_file.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <optional>
#include <string>
#include <system_error>
#include <utility>

namespace waymark {
namespace {

void check_map_options(const SlamConfig& config) {
  const bool is_loaded = !config.load_map.empty();
  const bool is_used = is_loaded || !config.save_map.empty();
  if (is_used && config.slam.estimator != EstimatorName::kWaymark)
    throw SetupError{"only the estimator 'waymark' loads and saves maps: set slam.estimator"};
  if (is_loaded && config.slam.mode == MapMode::kMap) {
    throw SetupError{
        "--load-map needs a mode: --mode localise (the map stays as it is) or --mode extend (new "
        "places are added)"};
  }
  if (!is_loaded && config.slam.mode != MapMode::kMap)
    throw SetupError{"--mode localise and extend need a map: --load-map FILE"};
  if (config.slam.mode == MapMode::kMap && config.slam.start.kind == StartKind::kLast &&
      config.save_map.empty()) {
    throw SetupError{
        "slam.start = last needs a map: --load-map FILE, or --save-map FILE for one that is saved "
        "by an earlier run"};
  }
  if (config.slam.save_map_every_s > 0.0 && config.save_map.empty())
    throw SetupError{"slam.save_map_every_s needs the file: --save-map FILE"};
  if (config.slam.mode == MapMode::kLocalise && !config.save_map.empty())
    throw SetupError{
        "slam.mode = localise leaves the map as it is: --save-map needs map or extend"};
}

/// Whether there is a map that --save-map is to continue, and not only to replace. (The map of
/// --load-map is replaced by its extension.)
bool is_to_be_continued(const SlamConfig& config) {
  std::error_code none;
  return config.slam.start.kind == StartKind::kLast &&
         std::filesystem::exists(config.save_map, none) &&
         !std::filesystem::equivalent(config.save_map, config.load_map, none);
}

/// Refuses to replace a recording, or any other file that has content and is not a map.
void protect_other_files(const SlamConfig& config) {
  if (config.save_map.empty() || is_to_be_continued(config)) return;
  for (const auto& file : {config.save_map, part_path_of(config.save_map)}) {
    std::error_code none;
    if (!std::filesystem::exists(file, none) || std::filesystem::is_empty(file, none)) continue;
    try {
      if (is_map_file(file)) continue;
    } catch (const std::exception& error) {
      throw SetupError{fmt::format("--save-map: {}", error.what())};
    }
    throw SetupError{fmt::format(
        "--save-map: '{}' is there already and is not a map, so that it is not replaced: give "
        "another name",
        file.string())};
  }
}

/// The file of --save-map, if the last pose is in its map: mapping was interrupted. If it is not,
/// keeps_old_map is set.
std::optional<MapFile> left_unfinished(SlamConfig& config) {
  if (!is_to_be_continued(config)) return std::nullopt;
  std::string why_not;
  try {
    const auto last = read_last_pose(config.slam.state_folder);
    MapFile file = read_map_file(config.save_map);
    if (last && is_in_map(*last, file.map.map_id)) return file;
    why_not = last ? "the last pose is in another map" : "there is no last pose";
  } catch (const std::exception& error) {
    why_not = error.what();
  }
  logging::warn(
      "the map in '{}' is not continued: {}; when this run saves its map there, the old file gets "
      "another name",
      config.save_map.string(), why_not);
  config.keeps_old_map = true;
  return std::nullopt;
}

}  // namespace

std::shared_ptr<const MapSnapshot> load_map(SlamConfig& config, std::string& frame) {
  frame = config.robot.markers.survey_file.empty() ? "map" : "survey";
  check_map_options(config);
  protect_other_files(config);
  std::optional<MapFile> found = left_unfinished(config);
  if (found) {
    logging::info("continues the map in '{}'", config.save_map.string());
    config.load_map = config.save_map;
    config.slam.mode = MapMode::kExtend;
  }
  if (config.load_map.empty()) {
    config.slam.start = {};  // a new map
    return nullptr;
  }
  MapFile file = found ? std::move(*found) : read_map_file(config.load_map);
  const MarkerConfig& markers = config.robot.markers;
  const auto refuse = [&](const std::string& why) {
    throw SetupError{fmt::format("map '{}' {}", config.load_map.string(), why)};
  };
  if (file.info.marker_dictionary != markers.dictionary ||
      file.info.marker_size_m != markers.size_m) {
    refuse(fmt::format("was made with markers {} of {} m, but robot.markers says {} of {} m",
                       file.info.marker_dictionary, file.info.marker_size_m, markers.dictionary,
                       markers.size_m));
  }
  if (file.map.grid.frame.resolution_m != config.slam.grid.resolution_m) {
    refuse(fmt::format("has cells of {} m: set slam.grid.resolution_m, which is {}, to that",
                       file.map.grid.frame.resolution_m, config.slam.grid.resolution_m));
  }
  const bool is_empty = file.map.landmarks.empty() && file.map.walls.sums().empty();
  const bool is_searched =
      config.slam.start.kind == StartKind::kAnywhere || config.slam.start.kind == StartKind::kLast;
  if (is_searched && is_empty)
    refuse(
        "has neither markers nor walls: slam.start = anywhere or last cannot find the robot there");
  frame = file.info.frame;
  return std::make_shared<const MapSnapshot>(std::move(file.map));
}

std::vector<SurveyedMarker> load_survey(const SlamConfig& config) {
  const std::string& file = config.robot.markers.survey_file;
  if (file.empty()) return {};
  if (config.slam.estimator != EstimatorName::kWaymark) {
    logging::info("the survey '{}' is not used: only the estimator 'waymark' can", file);
    return {};
  }
  std::vector<SurveyedMarker> survey = read_survey(file, config.robot.markers.dictionary);
  if (!config.load_map.empty())
    logging::info("the survey '{}' is checked, but not used: the loaded map has its frame", file);
  return survey;
}

}  // namespace waymark
