// SPDX-License-Identifier: BSD-3-Clause
#include "export/mcap_export.hpp"

#include "common/logging/logging.hpp"
#include "common/messages/convert.hpp"
#include "export/even_scan.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace waymark::exporting {
namespace {

using std::chrono::seconds;

constexpr Duration kMapPeriod = seconds{2};
constexpr double kMarkerHeight_m = 0.3;  // for display; the map has no heights
constexpr double kMarkerSide_m = 0.4;
constexpr double kMarkerThickness_m = 0.02;
constexpr Colour kMarkerColour{0.1, 0.4, 0.9, 0.9};
constexpr Colour kMovedColour{0.6, 0.1, 0.7, 0.9};
constexpr Colour kEllipseColour{0.9, 0.5, 0.0, 1.0};
constexpr Colour kTextColour{0.0, 0.0, 0.0, 1.0};

/// Removes all entities of a scene.
Json delete_all_json(Timestamp time) {
  constexpr int kDeleteAll = 1;
  return Json::array({{{"timestamp", time_json(time)}, {"type", kDeleteAll}, {"id", ""}}});
}

viewer::TimedPose timed_pose(const pose2D_t& message) {
  return {timestamp_from_us(message.utime), to_se2(message)};
}

Json marker_json(Timestamp time, const viewer::Landmark& landmark) {
  const std::string name = landmark.instance == 0
                               ? fmt::format("{}", landmark.id)
                               : fmt::format("{}/{}", landmark.id, landmark.instance);
  Json entity = entity_json(time, "marker " + name);
  const Se2& pose = landmark.map_from_marker;
  const bool was_moved = landmark.state == viewer::LandmarkState::kMoved;
  entity["cubes"].push_back(
      {{"pose", pose_json(pose, kMarkerHeight_m)},
       {"size", vector_json(kMarkerThickness_m, kMarkerSide_m, kMarkerSide_m)},
       {"color", colour_json(was_moved ? kMovedColour : kMarkerColour)}});
  entity["texts"].push_back({{"pose", pose_json(pose, kMarkerHeight_m + kMarkerSide_m)},
                             {"billboard", true},
                             {"font_size", 12.0},
                             {"scale_invariant", true},
                             {"color", colour_json(kTextColour)},
                             {"text", name}});
  entity["lines"].push_back(
      ellipse_json(pose.translation(), landmark.covariance.topLeftCorner<2, 2>(), kEllipseColour));
  return entity;
}

}  // namespace

McapExport::McapExport(const std::filesystem::path& out, Inbox& inbox)
    : file_{out}, counters_{inbox.counters()}, updater_{scene_, inbox.counters()} {
  try {
    writer_.emplace(out);
  } catch (const std::exception& error) {
    throw SetupError{error.what()};
  }
  const auto channel = [this](const char* topic, const std::string& type) {
    return writer_->add_channel(topic, "foxglove." + type, foxglove_schema(type));
  };
  map_ = channel("/map", "Grid");
  scan_ = channel("/scan", "LaserScan");
  pose_ = channel("/pose", "PoseInFrame");
  ellipse_ = channel("/pose_ellipse", "SceneUpdate");
  tf_ = channel("/tf", "FrameTransforms");
  markers_ = channel("/markers", "SceneUpdate");
  camera_ = channel("/camera", "CompressedImage");
  truth_ = channel("/truth", "PoseInFrame");
  const auto add_of_map = [this](const auto& message) {
    if (follow(message.map_id, timestamp_from_us(message.utime))) add(message);
  };
  inbox.on<annotated_scan_t>(channels::kSlamScan, [this](const auto& m) { add(m); });
  inbox.on<image_t>(channels::kCamera, [this](const auto& m) { add(m); });
  inbox.on<map_tiles_t>(channels::kSlamMap, add_of_map);
  inbox.on<marker_map_t>(channels::kSlamMarkers, add_of_map);
  inbox.on<slam_estimate_t>(channels::kSlamEstimate, add_of_map);
  inbox.on<pose2D_t>(channels::kOdometry, [this](const auto& m) { add_odometry(m); });
  inbox.on<pose2D_t>(channels::kTruePose, [this](const auto& m) { add_truth(m); });
}

void McapExport::write(McapWriter::ChannelId channel, Timestamp time, const Json& message) {
  newest_ = std::max(newest_, time);
  if (failed_) return;
  try {
    writer_->write(channel, time, message.dump());
  } catch (const std::exception& error) {
    failed_ = true;
    logging::error("{}", error.what());
  }
}

void McapExport::write_transform(Timestamp time, const Json& transform) {
  write(tf_, time, {{"transforms", Json::array({transform})}});
}

void McapExport::write_pose(McapWriter::ChannelId channel, Timestamp time, const char* frame,
                            const Se2& pose) {
  write(channel, time,
        {{"timestamp", time_json(time)}, {"frame_id", frame}, {"pose", pose_json(pose)}});
}

void McapExport::add(const annotated_scan_t& message) {
  const Timestamp time = timestamp_from_us(message.utime);
  if (message.angles.empty()) return;
  const EvenScan scan = even_scan(message.angles, message.ranges);
  const Se2 map_from_lidar{message.x_m, message.y_m, message.theta_rad};
  write(scan_, time,
        {{"timestamp", time_json(time)},
         {"frame_id", "map"},
         {"pose", pose_json(map_from_lidar)},
         {"start_angle", scan.start_angle_rad},
         {"end_angle", scan.end_angle_rad},
         {"ranges", scan.ranges_m},
         {"intensities", Json::array()}});
}

void McapExport::add(const image_t& message) {
  if (message.pixelformat != image_t::PIXEL_FORMAT_MJPEG) {
    counters_.add("CAMERA left out: not a JPEG");
    return;
  }
  const Timestamp time = timestamp_from_us(message.utime);
  write(camera_, time,
        {{"timestamp", time_json(time)},
         {"frame_id", "camera"},
         {"data", base64(message.data)},
         {"format", "jpeg"}});
}

void McapExport::add(const map_tiles_t& message) {
  updater_.add(message);
  map_has_changed_ = true;
  const Timestamp time = timestamp_from_us(message.utime);
  const bool is_last_part = message.part + 1 == message.num_parts;
  if (is_last_part && (!last_map_ || abs(time - *last_map_) >= kMapPeriod)) write_map(time);
}

void McapExport::write_map(Timestamp time) {
  const viewer::GridMap grid = scene_.map.grid();
  if (grid.empty()) return;
  last_map_ = time;
  map_has_changed_ = false;
  constexpr int kInt8 = 2;  // of PackedElementField
  const cv::Mat cells = grid.occupancy_percent.isContinuous() ? cv::Mat{grid.occupancy_percent}
                                                              : grid.occupancy_percent.clone();
  const std::span bytes{cells.data, cells.total()};
  write(map_, time,
        {{"timestamp", time_json(time)},
         {"frame_id", "map"},
         {"pose", pose_json({grid.origin_m.x(), grid.origin_m.y(), 0.0})},
         {"column_count", cells.cols},
         {"cell_size", {{"x", grid.resolution_m}, {"y", grid.resolution_m}}},
         {"row_stride", cells.cols},
         {"cell_stride", 1},
         {"fields", Json::array({{{"name", "occupancy"}, {"offset", 0}, {"type", kInt8}}})},
         {"data", base64(bytes)}});
}

void McapExport::add(const marker_map_t& message) {
  updater_.add(message);
  if (message.part + 1 != message.num_parts) return;
  const Timestamp time = timestamp_from_us(message.utime);
  Json entities = Json::array();
  for (const viewer::Landmark& landmark : scene_.landmarks)
    entities.push_back(marker_json(time, landmark));
  write(markers_, time, {{"deletions", delete_all_json(time)}, {"entities", entities}});
}

void McapExport::add(const slam_estimate_t& message) {
  if (message.has_pose == 0) return;
  const Timestamp time = timestamp_from_us(message.utime);
  const Se2 map_from_base{message.x_m, message.y_m, message.theta_rad};
  write_pose(pose_, time, "map", map_from_base);
  Json entity = entity_json(time, "2 sigma");
  const Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>> covariance{
      message.covariance};
  entity["lines"].push_back(
      ellipse_json(map_from_base.translation(), covariance.topLeftCorner<2, 2>(), kEllipseColour));
  write(ellipse_, time, {{"deletions", Json::array()}, {"entities", Json::array({entity})}});
  odometry_.add_estimate({time, map_from_base});
  write_odometry();
  if (has_world_) return;
  true_poses_.add_estimate({time, map_from_base});
  write_truth();
}

void McapExport::add_odometry(const pose2D_t& message) {
  odometry_.add_pose(timed_pose(message));
  write_odometry();
}

void McapExport::write_odometry() {
  for (const auto& [time, odom_from_base] : odometry_.take_poses())
    write_transform(time, transform_json(time, "odom", "base", odom_from_base));
  for (const auto& [time, map_from_base, odom_from_base] : odometry_.take_pairs())
    write_transform(time,
                    transform_json(time, "map", "odom", map_from_base * odom_from_base.inverse()));
}

void McapExport::add_truth(const pose2D_t& message) {
  true_poses_.add_pose(timed_pose(message));
  write_truth();
}

void McapExport::write_truth() {
  for (const auto& [time, world_from_base] : true_poses_.take_poses())
    write_pose(truth_, time, "world", world_from_base);
  for (const auto& [time, map_from_base, world_from_base] : true_poses_.take_pairs()) {
    if (std::exchange(has_world_, true)) continue;
    true_poses_.forget_estimates();
    write_transform(
        time, transform_json(time, "world", "map", world_from_base * map_from_base.inverse()));
  }
}

bool McapExport::follow(std::int64_t map_id, Timestamp time) {
  using Origin = viewer::CurrentMap::Origin;
  const Origin origin = current_map_.update(map_id, time);
  if (origin == Origin::kOfNewMap) begin_map(time);
  if (origin == Origin::kLate)
    counters_.add("messages of an earlier map left out", CountKind::kLoss);
  return origin != Origin::kLate;
}

void McapExport::begin_map(Timestamp time) {
  updater_.begin_map();
  last_map_.reset();
  map_has_changed_ = false;
  true_poses_.forget_estimates();
  has_world_ = false;
  write(markers_, time, {{"deletions", delete_all_json(time)}, {"entities", Json::array()}});
}

void McapExport::count_losses() {
  const auto add = [this](std::string_view name, std::int64_t count) {
    if (count > 0) counters_.add(name, CountKind::kLoss, count);
  };
  add("SLAM_ESTIMATE without ODOMETRY around it", odometry_.num_unpaired());
  add("ODOMETRY left out: stamp out of order", odometry_.num_dropped_poses());
  add("TRUE_POSE left out: stamp out of order", true_poses_.num_dropped_poses());
}

void McapExport::finish() {
  odometry_.finish();
  write_odometry();
  true_poses_.finish();
  write_truth();
  count_losses();
  if (map_has_changed_) write_map(newest_);
  if (failed_) return;
  try {
    const std::uint64_t num_messages = writer_->num_messages();
    writer_->close();
    logging::info("{}: {} messages, {:.1f} MB", file_.string(), num_messages,
                  1e-6 * static_cast<double>(std::filesystem::file_size(file_)));
  } catch (const std::exception& error) {
    failed_ = true;
    logging::error("{}", error.what());
  }
}

}  // namespace waymark::exporting
