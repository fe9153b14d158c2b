// SPDX-License-Identifier: BSD-3-Clause
#include "viewer/http/live_feed.hpp"

#include "common/node/node.hpp"

#include <cmath>

namespace waymark::viewer {
namespace {

constexpr std::chrono::milliseconds kPostPeriod{200};
constexpr std::chrono::milliseconds kUnwatchedPeriod{1000};  // keeps the time slider's history
constexpr float kPathStep_m = 0.03F;
/// Enough for 30 km of path.
constexpr std::size_t kMaxPathPoints = 1'000'000;
/// More than the programs of a run; bounds memory.
constexpr std::size_t kMaxProcesses = 16;
/// A square of 200 m in tiles of 32 cells of 0.05 m; further tiles are not shown.
constexpr std::size_t kMaxTiles = 16'000;

}  // namespace

LiveFeed::LiveFeed(ViewStore& views, std::string title, Pace pace) : views_{views}, pace_{pace} {
  current_.title = std::move(title);
}

void LiveFeed::begin_map() {
  map_ = LiveMap{.layout = map_.layout, .generation = map_.generation + 1};
  tile_index_.clear();
  map_changed_ = true;
  current_.estimate.reset();
  current_.markers.clear();
  current_.findings.clear();
  current_.particles.clear();
  current_.scan.clear();
  current_.path_begin = current_.path_length;
}

void LiveFeed::add(const map_tiles_t& message) {
  const TileLayout layout{message.origin_x_m, message.origin_y_m, message.resolution_m,
                          message.tile_size_cells};
  if (layout != map_.layout) {
    map_ = LiveMap{.layout = layout, .generation = map_.generation + 1};
    tile_index_.clear();
    map_changed_ = true;
  }
  for (const map_tile_t& tile : message.tiles) {
    const auto [found, is_new] =
        tile_index_.try_emplace({tile.tile_x, tile.tile_y}, map_.tiles.size());
    if (is_new && map_.tiles.size() >= kMaxTiles) {
      tile_index_.erase(found);
      continue;
    }
    if (!is_new && map_.tiles[found->second]->occupancy_percent == tile.occupancy) continue;
    if (is_new) map_.tiles.emplace_back();
    map_.tiles[found->second] = std::make_shared<LiveTile>(
        LiveTile{tile.tile_x, tile.tile_y, ++map_.version, tile.occupancy});
    map_changed_ = true;
  }
  advance_to(timestamp_from_us(message.utime));
}

void LiveFeed::add(const annotated_scan_t& message) {
  const Se2 map_from_lidar{message.x_m, message.y_m, message.theta_rad};
  current_.scan.clear();
  for (std::size_t i = 0; i < message.ranges.size(); ++i) {
    const double range_m = static_cast<double>(message.ranges[i]);
    if (!std::isfinite(range_m)) continue;
    const double angle_rad = static_cast<double>(message.angles[i]);
    const Eigen::Vector2d end = map_from_lidar * Eigen::Vector2d{range_m * std::cos(angle_rad),
                                                                 range_m * std::sin(angle_rad)};
    current_.scan.push_back({static_cast<float>(end.x()), static_cast<float>(end.y())});
  }
  advance_to(timestamp_from_us(message.utime));
}

void LiveFeed::add(const particles_t& message) {
  current_.particles.clear();
  for (const particle_t& particle : message.particles)
    current_.particles.emplace_back(particle.pose.x, particle.pose.y, particle.pose.theta);
  advance_to(timestamp_from_us(message.utime));
}

void LiveFeed::add(const image_t& message) {
  const Timestamp time = timestamp_from_us(message.utime);
  current_.last_camera = time;
  const bool is_due = !current_.camera || time < current_.camera->time ||
                      time - current_.camera->time >= std::chrono::seconds{1};
  if (message.pixelformat == image_t::PIXEL_FORMAT_MJPEG && is_due) {
    current_.camera = std::make_shared<CameraFrame>(
        CameraFrame{time, {message.data.begin(), message.data.end()}});
  }
  advance_to(time);
}

void LiveFeed::add(const marker_detections_t& message) {
  const Timestamp time = timestamp_from_us(message.utime);
  current_.last_camera = time;
  // With images, only the detections in the shown image are kept; else those of every frame.
  if (!current_.camera || current_.camera->time == time) {
    SeenMarkers seen{
        .time = time, .image_width = message.image_width, .image_height = message.image_height};
    for (const marker_detection_t& detection : message.detections) {
      SeenMarker& marker = seen.markers.emplace_back();
      marker.id = detection.id;
      for (std::size_t corner = 0; corner < 4; ++corner)
        marker.corners_px[corner] = {detection.corners_px[corner][0],
                                     detection.corners_px[corner][1]};
    }
    current_.seen_markers = std::move(seen);
  }
  advance_to(time);
}

void LiveFeed::add(const process_status_t& message) {
  if (!processes_.contains(message.process) && processes_.size() >= kMaxProcesses) return;
  ProcessState& process = processes_[message.process];
  process = {.name = message.process, .state = message.state};
  for (const counter_t& counter : message.counters) {
    if (counter.kind != counter_t::KIND_EVENT && counter.value > 0)
      process.losses.emplace_back(counter.name, counter.value);
  }
  post_when_due();
}

void LiveFeed::add(const slam_estimate_t& message, const EstimatedPose& estimate) {
  current_.estimate = estimate;
  current_.is_unplaced = false;
  if (message.markers_in_view > 0) current_.last_marker = estimate.time;
  grow_path(estimate.map_from_base);
  advance_to(estimate.time);
}

void LiveFeed::add_unplaced(Timestamp time) {
  current_.estimate.reset();
  current_.is_unplaced = true;
  advance_to(time);
}

void LiveFeed::add_markers(Timestamp time, const std::vector<Landmark>& landmarks) {
  current_.markers = landmarks;
  advance_to(time);
}

void LiveFeed::add_findings(Timestamp time, const std::vector<Finding>& findings) {
  current_.findings = findings;
  advance_to(time);
}

void LiveFeed::note_silences(const Silences& silences) {
  current_.silences = silences;
  post_when_due();
}

void LiveFeed::grow_path(const Se2& map_from_base) {
  const PathPoint point{static_cast<float>(map_from_base.x()),
                        static_cast<float>(map_from_base.y())};
  const bool is_first = current_.path_length == current_.path_begin;
  const float step_m = std::hypot(point[0] - last_path_point_[0], point[1] - last_path_point_[1]);
  if (!is_first && step_m < kPathStep_m) return;
  if (current_.path_length >= kMaxPathPoints) return;
  last_path_point_ = point;
  path_growth_.push_back(point);
  ++current_.path_length;
}

void LiveFeed::advance_to(Timestamp time) {
  const bool is_first = current_.time == Timestamp{};
  const bool fits = time >= current_.time - kLongestDelay &&
                    time <= current_.time + ClockStepDetector::kLongestPause;
  if (is_first || fits) {
    current_.time = std::max(current_.time, time);
    clock_steps_.note_consistent();
  } else if (clock_steps_.note_inconsistent(time)) {
    follow_clock(time);
  }
  post_when_due();
}

void LiveFeed::follow_clock(Timestamp time) {
  const Timestamp before = current_.time;
  const Duration step = clock_steps_.first_inconsistent() - before;
  for (auto* last : {&current_.last_camera, &current_.last_marker}) {
    // What came since the step has a stamp of the new clock.
    const bool is_of_old_clock = *last && abs(**last - before) < abs(**last - time);
    if (is_of_old_clock) **last += step;
  }
  current_.time = time;
}

void LiveFeed::post_when_due() {
  if (pace_ == Pace::kMessageTime) {
    const bool is_due = current_.time < last_post_ || current_.time - last_post_ >= kPostPeriod;
    if (current_.number != 0 && !is_due) return;
    last_post_ = current_.time;
    post_last();
    return;
  }
  const auto now = std::chrono::steady_clock::now();
  const auto period = views_.is_watched() ? kPostPeriod : kUnwatchedPeriod;
  if (now - last_post_wall_ < period) return;
  if (!views_.try_post(snapshot(), path_growth_)) return;
  last_post_wall_ = now;
  path_growth_.clear();
}

void LiveFeed::post_last() {
  views_.post(snapshot(), path_growth_);
  path_growth_.clear();
}

ViewPtr LiveFeed::snapshot() {
  if (map_changed_) current_.map = std::make_shared<LiveMap>(map_);
  map_changed_ = false;
  current_.processes.clear();
  for (const auto& [name, process] : processes_)
    current_.processes.push_back(process);
  ++current_.number;
  return std::make_shared<LiveView>(current_);
}

}  // namespace waymark::viewer
