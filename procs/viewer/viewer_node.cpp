// SPDX-License-Identifier: BSD-3-Clause
#include "viewer/viewer_node.hpp"

#include "common/bus/ask_slam.hpp"
#include "common/bus/bus.hpp"
#include "common/logging/logging.hpp"
#include "common/pictures/png.hpp"
#include "common/runtime/signals.hpp"
#include "viewer/core/painters/layer_painter.hpp"
#include "viewer/core/painters/map_painter.hpp"
#include "viewer/core/painters/plain_painter.hpp"
#include "viewer/core/painters/scan_painter.hpp"
#include "viewer/files/g2o_text.hpp"
#include "viewer/files/map_files.hpp"
#include "viewer/files/text_files.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <array>
#include <thread>
#include <utility>

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

/// True when a period has passed since `last`, which then becomes `now`. The first call and a jump
/// back in time restart the period.
bool is_due(std::optional<Timestamp>& last, Timestamp now, double period_s) {
  if (!last || now < *last) last = now;
  if (now - *last < duration_from_seconds(period_s)) return false;
  last = now;
  return true;
}

/// False when all files would be empty: they would only replace those of an earlier run.
bool has_slam_data(const viewer::Scene& scene) {
  return !scene.estimates.empty() || !scene.map.empty() || !scene.landmarks.empty() ||
         !scene.final_trajectory.empty();
}

void log_change(const viewer::Change& change) {
  if (change.kind == viewer::Change::Kind::kAlarm) {
    logging::warn("{}", change.text);
  } else {
    logging::info("{}", change.text);
  }
}

}  // namespace

ViewerNode::ViewerNode(const Config& config, Inbox& inbox, Outbox& /*outbox*/)
    : config_{config},
      updater_{scene_, inbox.counters()},
      folder_{required_folder(config.out_dir)},
      pacer_{config.viewer.max_write_share} {
  scene_.title = config_.viewer.title.empty() ? folder_name(folder_.path()) : config_.viewer.title;
  if (!config_.http.empty()) start_page();
  subscribe(inbox);
}

void ViewerNode::check(const Config& config) {
  if (!config.http.empty()) viewer::check_http_address(viewer::parse_http_address(config.http));
  if (!config.http_token.empty()) viewer::parse_http_token(config.http_token);
}

void ViewerNode::start_page() {
  using Pace = viewer::LiveFeed::Pace;
  const viewer::HttpAddress address = viewer::parse_http_address(config_.http);
  live_feed_.emplace(views_, scene_.title,
                     config_.is_replay ? Pace::kMessageTime : Pace::kWallClock);
  page_server_ =
      std::make_unique<viewer::PageServer>(address, views_, folder_.path(), page_commands());
  logging::info("the live page is {}", address.url());
  if (!address.is_loopback())
    logging::warn("everybody who reaches {} can look at the live page", address.host);
}

/// Without a token nullopt: the page is read-only.
std::optional<viewer::PageCommands> ViewerNode::page_commands() const {
  if (config_.http_token.empty()) return std::nullopt;
  return viewer::PageCommands{.token = viewer::parse_http_token(config_.http_token),
                              .ask = [url = lcm_url_or_default(config_.lcm_url),
                                      names = config_.channels](const command_t& command) {
                                return ask_slam(url, names, command);
                              }};
}

template <class Type>
void ViewerNode::subscribe_both(Inbox& inbox, Channel<Type> channel, Backlog backlog) {
  inbox.on<Type>(
      channel,
      [this](const Type& message) {
        updater_.add(message);
        if (live_feed_) live_feed_->add(message);
      },
      backlog);
}

void ViewerNode::subscribe_page(Inbox& inbox) {
  const auto feed = [this](const auto& message) {
    live_feed_->add(message);
  };
  inbox.on<image_t>(channels::kCamera, feed, Backlog::kNewestOnly);
  inbox.on<marker_detections_t>(channels::kMarkers, feed);
  for (const auto& channel : {channels::kSimStatus, channels::kDetectorStatus,
                              channels::kSlamStatus, channels::kRecorderStatus})
    inbox.on<process_status_t>(channel, feed);
}

void ViewerNode::subscribe(Inbox& inbox) {
  if (live_feed_) subscribe_page(inbox);
  inbox.on<map_tiles_t>(channels::kSlamMap, [this](const auto& m) {
    if (!follow(m.map_id, timestamp_from_us(m.utime))) return;
    updater_.add(m);
    if (live_feed_) live_feed_->add(m);
  });
  inbox.on<map_changes_t>(channels::kSlamChanges, [this](const auto& m) {
    if (follow(m.map_id, timestamp_from_us(m.utime))) updater_.add(m);
  });
  inbox.on<findings_t>(channels::kSlamFindings, [this](const auto& m) {
    if (!follow(m.map_id, timestamp_from_us(m.utime))) return;
    updater_.add(m);
    if (live_feed_) live_feed_->add_findings(timestamp_from_us(m.utime), *scene_.findings);
  });
  inbox.on<marker_map_t>(channels::kSlamMarkers, [this](const auto& m) {
    if (!follow(m.map_id, timestamp_from_us(m.utime))) return;
    updater_.add(m);
    for (const auto& change : change_monitor_.update(timestamp_from_us(m.utime), scene_.landmarks))
      log_change(change);
    if (live_feed_) live_feed_->add_markers(timestamp_from_us(m.utime), scene_.landmarks);
  });
  subscribe_both(inbox, channels::kSlamScan);
  inbox.on<trajectory_t>(channels::kSlamTrajectory, [this](const auto& m) {
    if (follow(m.map_id, timestamp_from_us(m.utime))) updater_.add(m);
  });
  inbox.on<pose_graph_t>(channels::kMapGraph, [this](const auto& m) {
    if (m.part == 0) graph_parts_.clear();
    if (m.part == std::ssize(graph_parts_)) graph_parts_.push_back(m);
  });
  subscribe_both(inbox, channels::kSlamParticles, Backlog::kNewestOnly);
  inbox.on<pose2D_t>(channels::kOdometry, [this](const auto& m) { updater_.add_odometry(m); });
  inbox.on<pose2D_t>(channels::kTruePose, [this](const auto& m) { updater_.add_truth(m); });
  inbox.on<slam_estimate_t>(channels::kSlamEstimate, [this](const auto& m) {
    if (!follow(m.map_id, timestamp_from_us(m.utime))) return;
    if (m.has_pose != 0)
      updater_.add(m);
    else if (live_feed_)
      live_feed_->add_unplaced(timestamp_from_us(m.utime));
    if (m.has_pose != 0 && !scene_.estimates.empty()) {
      if (const auto change = change_monitor_.update(scene_.estimates.back())) log_change(*change);
      if (live_feed_) live_feed_->add(m, scene_.estimates.back());
    }
    write_when_due(timestamp_from_us(m.utime));
  });
}

void ViewerNode::poll(const WallClock& clock) {
  if (!live_feed_) return;
  viewer::Silences silences{.slam_s = {},
                            .estimate_s = clock.silence_s(channels::kSlamEstimate.name),
                            .lidar_s = clock.silence_s(channels::kLidar.name),
                            .odometry_s = clock.silence_s(channels::kOdometry.name)};
  silences.slam_s = silences.estimate_s;
  if (const auto status_s = clock.silence_s(channels::kSlamStatus.name))
    silences.slam_s = std::min(*status_s, silences.slam_s.value_or(*status_s));
  live_feed_->note_silences(silences);
}

bool ViewerNode::follow(std::int64_t map_id, Timestamp time) {
  using Origin = viewer::CurrentMap::Origin;
  const auto old_map_id = current_map_.id();
  const Origin origin = current_map_.update(map_id, time);
  if (origin == Origin::kOfNewMap) {
    logging::info("slam has begun map {:016x}", static_cast<std::uint64_t>(map_id));
    archive_map(*old_map_id);
    graph_parts_.clear();
    updater_.begin_map();
    change_monitor_ = {};
    if (live_feed_) live_feed_->begin_map();
  }
  return origin != Origin::kLate;
}

void ViewerNode::archive_map(std::int64_t map_id) {
  constexpr int kMaxArchived = 20;  // bounds the disk space if slam restarts again and again
  if (!has_slam_data(scene_) || num_archived_ > kMaxArchived) return;
  if (++num_archived_ > kMaxArchived) {
    logging::warn("{}: the files of {} maps are kept; those of further maps are not",
                  folder_.path().string(), kMaxArchived);
    return;
  }
  const auto path = folder_.path() / fmt::format("map-{:016x}", static_cast<std::uint64_t>(map_id));
  try {
    viewer::OutputFolder current = std::exchange(folder_, viewer::OutputFolder{path});
    write_files();
    archive_failed_ |= !folder_.failed_files().empty();
    folder_ = std::move(current);
    logging::info("the map before is in '{}'", path.string());
  } catch (const SetupError& error) {
    logging::error("the map before is lost: {}", error.what());
    archive_failed_ = true;
  }
}

void ViewerNode::write_when_due(Timestamp time) {
  const auto start = viewer::Pacer::Clock::now();
  if (!pacer_.may_start(start)) return;
  if (!is_due(last_write_time_, time, config_.viewer.write_period_s)) return;
  write_data();
  constexpr std::array kPictures{&ViewerNode::write_map_picture, &ViewerNode::write_marker_layer,
                                 &ViewerNode::write_scan_and_plain_map};
  (this->*kPictures[next_picture_])();
  next_picture_ = (next_picture_ + 1) % kPictures.size();
  pacer_.record_work(start, viewer::Pacer::Clock::now());
}

template <class MakeBytes>
void ViewerNode::write_or_remove(const std::string& name, bool has_data, MakeBytes make_bytes) {
  if (has_data)
    folder_.write(name, make_bytes());
  else
    folder_.remove(name);
}

void ViewerNode::write_data() {
  const viewer::GridMap map = scene_.map.grid();
  folder_.write("map.pgm", viewer::pgm_text(map, config_.viewer.map_page.thresholds));
  folder_.write("map.yaml",
                viewer::map_yaml_text(map, config_.viewer.map_page.thresholds, "map.pgm"));
  const bool has_estimates = !scene_.estimates.empty();  // a map file has none
  write_or_remove("trajectory.tum", has_estimates,
                  [this] { return viewer::tum_text(scene_.estimates); });
  write_or_remove("covariance.csv", has_estimates,
                  [this] { return viewer::covariance_csv_text(scene_.estimates); });
  write_or_remove("odometry.tum", has_estimates,
                  [this] { return viewer::tum_text(scene_.odometry); });
  folder_.write("markers.csv", viewer::markers_csv_text(scene_.landmarks));
  write_or_remove("findings.json", scene_.findings.has_value(),
                  [this] { return viewer::findings_json_text(*scene_.findings); });
  write_or_remove("changes.csv", scene_.changes.has_value(),
                  [this] { return viewer::changes_csv_text(*scene_.changes); });
}

void ViewerNode::write_final_trajectory() {
  write_or_remove("trajectory_final.tum", !scene_.final_trajectory.empty(),
                  [this] { return viewer::tum_text(scene_.final_trajectory); });
}

/// Writes graph.g2o when all parts have come.
void ViewerNode::write_graph() {
  const bool is_complete =
      !graph_parts_.empty() && std::ssize(graph_parts_) == graph_parts_.front().num_parts;
  write_or_remove("graph.g2o", is_complete, [this] { return viewer::g2o_text(graph_parts_); });
}

void ViewerNode::write_map_picture() {
  const cv::Mat picture = viewer::paint_map(scene_, config_.viewer.map_page);
  folder_.write("map.png", png_bytes(picture));
}

void ViewerNode::write_marker_layer() {
  const cv::Mat picture = viewer::paint_marker_layer(
      scene_.map.grid(), scene_.title + ": marker id per cell", config_.viewer.map_page);
  folder_.write("marker_layer.png", png_bytes(picture));
}

void ViewerNode::write_scan_and_plain_map() {
  const cv::Mat plain = viewer::paint_plain(scene_.map.grid(), config_.viewer.map_page.thresholds);
  folder_.write("plain.png", png_bytes(plain));
  write_or_remove("scan.png", scene_.scan.has_value(), [this] {
    return png_bytes(viewer::paint_scan(*scene_.scan, config_.viewer.scan_size_px));
  });
}

void ViewerNode::finish() {
  write_files();
  if (!live_feed_) return;
  live_feed_->post_last();
  if (!config_.is_replay) return;
  logging::info("the log is at its end; the page stays until Ctrl-C");
  while (stop_signal() == 0)
    std::this_thread::sleep_for(std::chrono::milliseconds{50});
}

void ViewerNode::write_files() {
  if (!has_slam_data(scene_)) {
    logging::warn("slam has given neither a pose nor a map: no map is written to {}",
                  folder_.path().string());
    return;
  }
  write_data();
  write_final_trajectory();
  write_graph();
  write_map_picture();
  write_marker_layer();
  write_scan_and_plain_map();
  if (const std::size_t num_left_out = scene_.map.num_left_out(); num_left_out > 0) {
    logging::error("{}: {} of the map's tiles are in no file: it would span more than {} cells",
                   folder_.path().string(), num_left_out, viewer::kMaxMapCells);
    map_was_cut_ = true;
  }
  if (!folder_.failed_files().empty()) {
    logging::error("{}: could not always be written: {}", folder_.path().string(),
                   fmt::join(folder_.failed_files(), ", "));
  }
}

}  // namespace waymark
