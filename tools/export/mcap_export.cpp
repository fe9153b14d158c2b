// SPDX-License-Identifier: BSD-3-Clause
#include "export/mcap_export.hpp"

#include "common/logging/logging.hpp"
#include "common/messages/convert.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace waymark::exporting {
namespace {

using std::chrono::seconds;

constexpr Duration kMapPeriod = seconds{2};
constexpr Duration kLongestGap = seconds{1};  // between poses that are interpolated
constexpr std::size_t kMostPoses = 2000;
constexpr double kMarkerHeight_m = 0.3;  // for display; the map has no heights
constexpr double kMarkerSide_m = 0.4;
constexpr double kMarkerThickness_m = 0.02;
constexpr Colour kMarkerColour{0.1, 0.4, 0.9, 0.9};
constexpr Colour kMovedColour{0.6, 0.1, 0.7, 0.9};
constexpr Colour kEllipseColour{0.9, 0.5, 0.0, 1.0};
constexpr Colour kTextColour{0.0, 0.0, 0.0, 1.0};

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

void RecentPoses::add(Timestamp time, const Se2& pose) {
  if (!poses_.empty() && time <= poses_.back().time) return;
  poses_.push_back({time, pose});
  if (poses_.size() > kMostPoses) poses_.pop_front();
}

std::optional<Se2> RecentPoses::at(Timestamp time) const {
  const auto after =
      std::lower_bound(poses_.begin(), poses_.end(), time,
                       [](const viewer::TimedPose& pose, Timestamp t) { return pose.time < t; });
  if (after == poses_.end()) return std::nullopt;
  if (after->time == time) return after->frame_from_base;
  if (after == poses_.begin()) return std::nullopt;
  const viewer::TimedPose& before = *(after - 1);
  if (after->time - before.time > kLongestGap) return std::nullopt;
  const double fraction = to_seconds(time - before.time) / to_seconds(after->time - before.time);
  return interpolate(before.frame_from_base, after->frame_from_base, fraction);
}

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
  inbox.on<annotated_scan_t>(channels::kSlamScan, [this](const auto& m) { add(m); });
  inbox.on<image_t>(channels::kCamera, [this](const auto& m) { add(m); });
  inbox.on<map_tiles_t>(channels::kSlamMap, [this](const auto& m) { add(m); });
  inbox.on<marker_map_t>(channels::kSlamMarkers, [this](const auto& m) { add(m); });
  inbox.on<slam_estimate_t>(channels::kSlamEstimate, [this](const auto& m) { add(m); });
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
  Json ranges = Json::array();
  // JSON has no infinity: 0 stands for "no return".
  for (const float range : message.ranges)
    ranges.push_back(std::isfinite(range) ? range : 0.0F);
  const Se2 map_from_lidar{message.x_m, message.y_m, message.theta_rad};
  write(scan_, time,
        {{"timestamp", time_json(time)},
         {"frame_id", "map"},
         {"pose", pose_json(map_from_lidar)},
         {"start_angle", message.angles.front()},
         {"end_angle", message.angles.back()},
         {"ranges", ranges},
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
  if (is_last_part && (!last_map_ || time - *last_map_ >= kMapPeriod)) write_map(time);
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
  constexpr int kDeleteAll = 1;
  Json entities = Json::array();
  for (const viewer::Landmark& landmark : scene_.landmarks)
    entities.push_back(marker_json(time, landmark));
  write(markers_, time,
        {{"deletions",
          Json::array({{{"timestamp", time_json(time)}, {"type", kDeleteAll}, {"id", ""}}})},
         {"entities", entities}});
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
  if (const auto odom_from_base = odometry_.at(time)) {
    write_transform(time,
                    transform_json(time, "map", "odom", map_from_base * odom_from_base->inverse()));
  } else {
    counters_.add("SLAM_ESTIMATE without ODOMETRY around it");
  }
  if (has_world_) return;
  if (const auto world_from_base = true_poses_.at(time)) {
    has_world_ = true;
    write_transform(
        time, transform_json(time, "world", "map", *world_from_base * map_from_base.inverse()));
  }
}

void McapExport::add_odometry(const pose2D_t& message) {
  const Timestamp time = timestamp_from_us(message.utime);
  odometry_.add(time, to_se2(message));
  write_transform(time, transform_json(time, "odom", "base", to_se2(message)));
}

void McapExport::add_truth(const pose2D_t& message) {
  const Timestamp time = timestamp_from_us(message.utime);
  true_poses_.add(time, to_se2(message));
  write_pose(truth_, time, "world", to_se2(message));
}

void McapExport::finish() {
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
