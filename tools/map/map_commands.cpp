// SPDX-License-Identifier: BSD-3-Clause
#include "map/map_commands.hpp"

#include "common/geometry/rounded.hpp"
#include "common/log/log_file.hpp"
#include "common/messages/bounds.hpp"
#include "map/map_agreement.hpp"
#include "map/map_merge.hpp"
#include "map/wall_alignment.hpp"
#include "slam/core/graph/calibration_terms.hpp"
#include "slam/map_file.hpp"
#include "viewer/viewer_node.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>

namespace waymark {
namespace {

std::string hex(std::int64_t map_id) {
  return fmt::format("{:016x}", static_cast<std::uint64_t>(map_id));
}

struct Extent {
  Eigen::Vector2d least{Eigen::Vector2d::Zero()};
  Eigen::Vector2d most{Eigen::Vector2d::Zero()};
  std::size_t mapped_cells{0};
};

Extent extent_of(const GridMap& grid) {
  Extent extent;
  grid.occupancy.for_each_tile([&](TileIndex index, const auto& cells) {
    for (std::size_t offset = 0; offset < kTileCells; ++offset) {
      if (!cells[offset].is_mapped()) continue;
      const Eigen::Vector2d centre = grid.frame.centre_of(cell_at(index, offset));
      extent.least = extent.mapped_cells == 0 ? centre : extent.least.cwiseMin(centre);
      extent.most = extent.mapped_cells == 0 ? centre : extent.most.cwiseMax(centre);
      ++extent.mapped_cells;
    }
  });
  return extent;
}

/// Existing maps are never replaced: to make one took a drive.
/// @throws SetupError if the file exists.
void check_is_new(const std::filesystem::path& out) {
  if (!std::filesystem::exists(out)) return;
  throw SetupError{out.string() + ": is there already; give --out another name, or move it away"};
}

/// @throws SetupError if the maps differ in marker type, cell size or scan-matching cell spacing.
void check_are_mergeable(const MapFile& a, const MapFile& b) {
  if (a.info.marker_dictionary != b.info.marker_dictionary ||
      a.info.marker_size_m != b.info.marker_size_m) {
    throw SetupError{fmt::format("the maps have other markers: {} of {} m and {} of {} m",
                                 a.info.marker_dictionary, a.info.marker_size_m,
                                 b.info.marker_dictionary, b.info.marker_size_m)};
  }
  const double cell_a_m = a.map.grid.frame.resolution_m;
  const double cell_b_m = b.map.grid.frame.resolution_m;
  if (cell_a_m != cell_b_m)
    throw SetupError{fmt::format("the maps have other cells: {} m and {} m", cell_a_m, cell_b_m)};
  const double spacing_a_m = a.map.walls.spacing_m();
  const double spacing_b_m = b.map.walls.spacing_m();
  if (spacing_a_m != spacing_b_m) {
    throw SetupError{
        fmt::format("the maps were made with other slam.waymark.scan.cell_spacing_m: {} and {}",
                    spacing_a_m, spacing_b_m)};
  }
}

/// @throws SetupError if the map would lie so far from the new origin that poses are not precise.
void check_is_near_origin(const MapSnapshot& map, const Se2& new_from_old) {
  const Extent old = extent_of(map.grid);
  for (const double x_m : {old.least.x(), old.most.x()}) {
    for (const double y_m : {old.least.y(), old.most.y()}) {
      const Eigen::Vector2d corner = new_from_old * Eigen::Vector2d{x_m, y_m};
      if (corner.cwiseAbs().maxCoeff() <= bounds::kMapCoordinate_m) continue;
      throw SetupError{fmt::format(
          "--x-m {:.10g} --y-m {:.10g}: the map would lie at x {:.7g} m, y {:.7g} m, but poses are "
          "precise to a millimetre only up to {:.0f} m from the origin; subtract a constant from "
          "--x-m and --y-m",
          new_from_old.x(), new_from_old.y(), corner.x(), corner.y(), bounds::kMapCoordinate_m)};
    }
  }
}

/// @throws std::runtime_error if the viewer has left out a part of the map.
void check_is_complete(const Counters& counters) {
  for (const auto& [name, count] : counters.all()) {
    if (count.kind == CountKind::kEvent || count.value == 0) continue;
    throw std::runtime_error{fmt::format(
        "the map is too large, so nothing is written: {} ({} times); its bounding rectangle may "
        "have {} million cells",
        name, count.value, viewer::kMaxMapCells / 1'000'000)};
  }
}

double sigma_of(const LearntCalibration& calibration, std::size_t term) {
  const auto i = static_cast<Eigen::Index>(term);
  return std::sqrt(std::max(0.0, calibration.covariance(i, i)));
}

nlohmann::json json_of(const LearntCalibration& calibration) {
  nlohmann::json json;
  for (std::size_t i = 0; i < kCalibrationTerms.size(); ++i) {
    json[kCalibrationTerms[i].key] = {{"mean", calibration.mean[static_cast<Eigen::Index>(i)]},
                                      {"sigma", sigma_of(calibration, i)}};
  }
  return json;
}

/// The learnt calibration: deviations of the robot from its description.
std::string text_of(const LearntCalibration& calibration) {
  std::string text;
  for (std::size_t i = 0; i < kCalibrationTerms.size(); ++i) {
    const CalibrationTerm& term = kCalibrationTerms[i];
    text +=
        fmt::format("{}{} {:+.4f} +- {:.4f} {}", i > 0 ? ", " : "", term.name,
                    rounded(term.per_unit * calibration.mean[static_cast<Eigen::Index>(i)], 1e4),
                    term.per_unit * sigma_of(calibration, i), term.unit);
  }
  return text;
}

}  // namespace

std::string map_info(const std::filesystem::path& file, bool as_json) {
  const auto [map, info] = read_map_file(file);
  const Extent extent = extent_of(map.grid);
  const Eigen::Vector2d size = extent.most - extent.least;
  const auto confirmed =
      std::count_if(map.landmarks.begin(), map.landmarks.end(),
                    [](const Landmark& marker) { return marker.is_confirmed(); });
  const double cell_m = map.grid.frame.resolution_m;
  const double area_m2 = cell_m * cell_m * static_cast<double>(extent.mapped_cells);
  if (as_json) {
    return nlohmann::json{{"map_id", hex(map.map_id)},
                          {"parent_map_id", hex(map.parent_map_id)},
                          {"frame", info.frame},
                          {"cell_m", cell_m},
                          {"size_x_m", size.x()},
                          {"size_y_m", size.y()},
                          {"mapped_m2", area_m2},
                          {"marker_dictionary", info.marker_dictionary},
                          {"marker_size_m", info.marker_size_m},
                          {"markers", map.landmarks.size()},
                          {"confirmed_markers", confirmed},
                          {"keyframes", map.graph.poses.size()},
                          {"edges", map.graph.edges.size()},
                          {"calibration", json_of(map.calibration)},
                          {"bytes", std::filesystem::file_size(file)}}
               .dump(2) +
           "\n";
  }
  return fmt::format(
      "map      {} (parent: {}), frame '{}'\n"
      "area     {:.1f} m x {:.1f} m, {:.1f} m2 mapped, cells of {} m\n"
      "markers  {} of {:.4g} m: {}, {} of them confirmed\n"
      "graph    {} keyframes, {} edges\n"
      "robot    differs from its description by: {}\n"
      "file     {:.1f} kB\n",
      hex(map.map_id), map.parent_map_id == 0 ? "none" : hex(map.parent_map_id), info.frame,
      size.x(), size.y(), area_m2, cell_m, info.marker_dictionary, info.marker_size_m,
      map.landmarks.size(), confirmed, map.graph.poses.size(), map.graph.edges.size(),
      text_of(map.calibration), 1e-3 * static_cast<double>(std::filesystem::file_size(file)));
}

void export_map(const std::filesystem::path& file, const std::filesystem::path& folder) {
  const MapFile map = read_map_file(file);
  check_is_new(folder / "map.yaml");
  std::filesystem::create_directories(folder);
  ViewerConfig config;
  config.out_dir = folder;
  config.viewer.title = file.filename().string();
  config.is_replay = true;
  Inbox inbox;
  Outbox outbox;
  ViewerNode viewer{config, inbox, outbox};
  LogReader reader{file};
  while (const auto message = reader.next())
    inbox.deliver(*message);
  check_is_complete(inbox.counters());
  viewer.finish();
  if (viewer.failed()) throw std::runtime_error{"not everything could be written"};
}

std::string transform_map(const std::filesystem::path& file, const Se2& new_from_old,
                          const std::string& frame, const std::filesystem::path& out) {
  check_is_new(out);
  MapFile map = read_map_file(file);
  check_is_near_origin(map.map, new_from_old);
  MapSnapshot moved = transformed(map.map, new_from_old);
  moved.parent_map_id = map.map.map_id;
  if (!frame.empty()) map.info.frame = frame;
  const std::int64_t map_id = write_map_file(out, moved, map.info);
  return fmt::format("map {} in frame '{}' is in '{}'", hex(map_id), map.info.frame, out.string());
}

std::string merge_maps(const std::filesystem::path& a, const std::filesystem::path& b,
                       const std::filesystem::path& out, MergeCheck check) {
  check_is_new(out);
  const MapFile first = read_map_file(a);
  const MapFile second = read_map_file(b);
  check_are_mergeable(first, second);
  auto alignment = align_by_markers(first.map, second.map);
  const bool is_by_markers = alignment.has_value();
  if (!is_by_markers) alignment = align_by_walls(first.map, second.map);
  if (!alignment) {
    throw SetupError{fmt::format(
        "'{}' and '{}' share no two markers, and no two stretches of walls that show every "
        "direction, that lie alike in both: nothing says how they fit",
        a.string(), b.string())};
  }
  const MapAgreement agreement = agreement_of(first.map, second.map, alignment->a_from_b);
  const std::string objection = agreement.objection();
  if (!objection.empty() && check == MergeCheck::kRefuse) {
    throw SetupError{fmt::format(
        "'{}' and '{}' do not show the same building: {}; nothing is written (--force merges them "
        "nevertheless)",
        a.string(), b.string(), objection)};
  }
  const std::int64_t map_id =
      write_map_file(out, merged(first.map, second.map, alignment->a_from_b), first.info);
  return fmt::format(
      "map {} of both is in '{}': aligned by {} {} to {:.3f} m; {}; {:.0f} % of the "
      "walls contradict each other{}",
      hex(map_id), out.string(), alignment->shared,
      is_by_markers ? "markers" : "stretches of walls", alignment->rms_m, agreement.markers_text(),
      100.0 * agreement.contradicting_walls, objection.empty() ? "" : " (merged by --force)");
}

}  // namespace waymark
