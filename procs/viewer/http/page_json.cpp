// SPDX-License-Identifier: BSD-3-Clause
#include "viewer/http/page_json.hpp"

#include "common/geometry/rounded.hpp"
#include "viewer/http/health_text.hpp"

#include <nlohmann/json.hpp>

#include <bit>
#include <cmath>
#include <cstring>

namespace waymark::viewer {
namespace {

using Json = nlohmann::ordered_json;

static_assert(std::endian::native == std::endian::little);

/// Rounds to 0.1 mm or 0.1 mrad, finer than the page can show.
double fine(double value) {
  return rounded(value, 1e4);
}

/// Rounds to millimetres.
double metres(float value) {
  return rounded(static_cast<double>(value), 1e3);
}

Json pose_json(const Se2& pose) {
  return {fine(pose.x()), fine(pose.y()), fine(pose.theta())};
}

Json points_json(std::span<const PathPoint> points) {
  Json flat = Json::array();
  for (const PathPoint& point : points) {
    flat.push_back(metres(point[0]));
    flat.push_back(metres(point[1]));
  }
  return flat;
}

Json seconds_json(const std::optional<double>& seconds) {
  return seconds ? Json(fine(*seconds)) : Json(nullptr);
}

double sigma(const Eigen::Matrix3d& covariance, int axis) {
  return std::sqrt(std::max(0.0, covariance(axis, axis)));
}

Json estimate_json(const EstimatedPose& estimate) {
  const Eigen::Matrix3d& c = estimate.covariance;
  Json json{{"pose", pose_json(estimate.map_from_base)},
            {"covariance_xy", {c(0, 0), c(0, 1), c(1, 1)}},
            {"sigma_heading_rad", sigma(c, 2)},
            {"weak_axis", nullptr}};
  if (estimate.weak_axis) {
    const Eigen::Vector3d& direction = estimate.weak_axis->direction;
    json["weak_axis"] = {
        {"direction", {fine(direction.x()), fine(direction.y()), fine(direction.z())}},
        {"source", source_name(estimate.weak_axis->source)}};
  }
  return json;
}

Json markers_json(const LiveView& view) {
  Json markers = Json::array();
  for (const Landmark& landmark : view.markers) {
    const Eigen::Matrix3d& c = landmark.covariance;
    markers.push_back({{"id", landmark.id},
                       {"instance", landmark.instance},
                       {"pose", pose_json(landmark.map_from_marker)},
                       {"sigmas", {sigma(c, 0), sigma(c, 1), sigma(c, 2)}},
                       {"sightings", landmark.sightings},
                       {"since_s", seconds_json(seconds_since(landmark.last_seen, view.time))},
                       {"state", name_of(landmark.state)}});
  }
  return markers;
}

Json particles_json(const std::vector<Se2>& particles) {
  constexpr std::size_t kMaxShown = 300;  // more cannot be distinguished on the page
  Json flat = Json::array();
  const std::size_t step = particles.size() / kMaxShown + 1;
  for (std::size_t i = 0; i < particles.size(); i += step) {
    flat.push_back(fine(particles[i].x()));
    flat.push_back(fine(particles[i].y()));
  }
  return flat;
}

Json camera_json(const LiveView& view) {
  if (!view.camera && !view.seen_markers) return nullptr;
  Json json{{"frame_s", nullptr}, {"size", nullptr}, {"seen", Json::array()}};
  if (view.camera) json["frame_s"] = to_seconds(view.camera->time);
  if (!view.seen_markers) return json;
  json["size"] = {view.seen_markers->image_width, view.seen_markers->image_height};
  json["seen_s"] = to_seconds(view.seen_markers->time);
  for (const SeenMarker& marker : view.seen_markers->markers)
    json["seen"].push_back({{"id", marker.id}, {"corners", marker.corners_px}});
  return json;
}

Json processes_json(const std::vector<ProcessState>& processes) {
  Json json = Json::array();
  for (const ProcessState& process : processes) {
    Json losses = Json::array();
    for (const auto& [name, count] : process.losses)
      losses.push_back({name, count});
    json.push_back({{"name", process.name}, {"state", process.state}, {"losses", losses}});
  }
  return json;
}

Json to_json(const LiveView& view, const ViewStore::Span& history) {
  return {{"time_s", to_seconds(view.time)},
          {"history_s", {to_seconds(history.first), to_seconds(history.last)}},
          {"title", view.title},
          {"health", health_name(view)},
          {"reason", health_reason(view)},
          {"estimate", view.estimate ? estimate_json(*view.estimate) : Json(nullptr)},
          {"since_marker_s", seconds_json(seconds_since(view.last_marker, view.time))},
          {"map", {{"generation", view.map->generation}, {"version", view.map->version}}},
          {"markers", markers_json(view)},
          {"particles", particles_json(view.particles)},
          {"scan", points_json(view.scan)},
          {"camera", camera_json(view)},
          {"processes", processes_json(view.processes)},
          {"path_begin", view.path_begin},
          {"path_length", view.path_length}};
}

/// Invalid UTF-8 in strings from messages is replaced.
std::string dump(const Json& json) {
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

template <class Value>
void append(std::string& bytes, Value value) {
  char raw[sizeof value];
  std::memcpy(raw, &value, sizeof value);
  bytes.append(raw, sizeof value);
}

}  // namespace

std::string view_json(const LiveView& view, const ViewStore::Span& history) {
  return dump(to_json(view, history));
}

std::string with_path(std::string view_json, std::size_t first,
                      std::span<const PathPoint> path_growth) {
  const Json path{{"first", first}, {"xy", points_json(path_growth)}};
  view_json.pop_back();  // the closing brace of view_json
  return view_json + ",\"path\":" + dump(path) + "}";
}

std::string tile_bytes(const LiveMap& map, std::uint32_t since_version) {
  std::string tiles;
  std::uint32_t num_tiles = 0;
  for (const auto& tile : map.tiles) {
    if (tile->version <= since_version) continue;
    ++num_tiles;
    append(tiles, tile->x);
    append(tiles, tile->y);
    for (const std::int8_t cell : tile->occupancy_percent)
      tiles.push_back(static_cast<char>(cell));
  }
  std::string bytes;
  append(bytes, map.generation);
  append(bytes, map.version);
  append(bytes, static_cast<std::uint32_t>(map.layout.size_cells));
  append(bytes, num_tiles);
  append(bytes, map.layout.origin_x_m);
  append(bytes, map.layout.origin_y_m);
  append(bytes, map.layout.resolution_m);
  return bytes + tiles;
}

}  // namespace waymark::viewer
