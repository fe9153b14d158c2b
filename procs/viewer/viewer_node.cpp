// SPDX-License-Identifier: BSD-3-Clause
#include "viewer/viewer_node.hpp"

#include "viewer/core/layer_painter.hpp"
#include "viewer/core/map_painter.hpp"
#include "viewer/core/plain_painter.hpp"
#include "viewer/core/scan_painter.hpp"
#include "viewer/map_files.hpp"
#include "viewer/png.hpp"
#include "viewer/text_files.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <spdlog/spdlog.h>

namespace waymark {
namespace {

const std::filesystem::path& required_folder(const std::filesystem::path& out_dir) {
  if (out_dir.empty())
    throw SetupError{"--out is missing: give the folder that the viewer shall write to"};
  return out_dir;
}

/// Name of the last folder of a path, also when it ends in a slash.
std::string folder_name(const std::filesystem::path& folder) {
  const auto path = std::filesystem::absolute(folder).lexically_normal();
  return (path.has_filename() ? path : path.parent_path()).filename().string();
}

/// True when a period has passed, or on the first call (which starts the period).
bool is_due(std::optional<Timestamp>& last, Timestamp now, double period_s) {
  if (!last) last = now;
  if (now - *last < duration_from_seconds(period_s)) return false;
  last = now;
  return true;
}

}  // namespace

ViewerNode::ViewerNode(const Config& config, Inbox& inbox, Outbox& /*outbox*/)
    : config_{config},
      updater_{scene_, inbox.counters()},
      folder_{required_folder(config.out_dir)} {
  scene_.title = config_.viewer.title.empty() ? folder_name(folder_.path()) : config_.viewer.title;
  subscribe(inbox);
}

void ViewerNode::subscribe(Inbox& inbox) {
  inbox.on<map_tiles_t>(channels::kSlamMap, [this](const auto& m) { updater_.add(m); });
  inbox.on<marker_map_t>(channels::kSlamMarkers, [this](const auto& m) { updater_.add(m); });
  inbox.on<annotated_scan_t>(channels::kSlamScan, [this](const auto& m) { updater_.add(m); });
  inbox.on<particles_t>(
      channels::kSlamParticles, [this](const auto& m) { updater_.add(m); }, Backlog::kNewestOnly);
  inbox.on<pose2D_t>(channels::kOdometry, [this](const auto& m) { updater_.add_odometry(m); });
  inbox.on<pose2D_t>(channels::kTruePose, [this](const auto& m) { updater_.add_truth(m); });
  inbox.on<slam_estimate_t>(channels::kSlamEstimate, [this](const auto& m) {
    updater_.add(m);
    write_when_due(timestamp_from_us(m.utime));
  });
}

void ViewerNode::write_when_due(Timestamp time) {
  if (is_due(last_data_time_, time, config_.viewer.write_period_s)) write_data();
  if (is_due(last_picture_time_, time, config_.viewer.picture_period_s)) write_pictures();
}

void ViewerNode::write_data() {
  const viewer::GridMap map = scene_.map.grid();
  folder_.write("map.pgm", viewer::pgm_text(map, config_.viewer.thresholds));
  folder_.write("map.yaml", viewer::map_yaml_text(map, config_.viewer.thresholds, "map.pgm"));
  folder_.write("trajectory.tum", viewer::tum_text(scene_.estimates));
  folder_.write("covariance.csv", viewer::covariance_csv_text(scene_.estimates));
  folder_.write("odometry.tum", viewer::tum_text(scene_.odometry));
  folder_.write("markers.csv", viewer::markers_csv_text(scene_.landmarks));
}

void ViewerNode::write_pictures() {
  const ViewerSection& settings = config_.viewer;
  const viewer::GridMap map = scene_.map.grid();
  folder_.write("map.png", viewer::png_bytes(viewer::paint_map(scene_, settings.map_page)));
  folder_.write("plain.png", viewer::png_bytes(viewer::paint_plain(map, settings.thresholds)));
  folder_.write("marker_layer.png",
                viewer::png_bytes(viewer::paint_marker_layer(
                    map, scene_.title + ": marker id per cell", settings.map_page)));
  if (scene_.scan)
    folder_.write("scan.png",
                  viewer::png_bytes(viewer::paint_scan(*scene_.scan, settings.scan_size_px)));
}

void ViewerNode::finish() {
  write_data();
  write_pictures();
  if (failed()) {
    spdlog::error("{}: could not always be written: {}", folder_.path().string(),
                  fmt::join(folder_.failed_files(), ", "));
  }
}

}  // namespace waymark
