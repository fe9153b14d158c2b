// SPDX-License-Identifier: BSD-3-Clause
#include "import/rosbag/rosbag_reader.hpp"

#include "common/errors/setup_error.hpp"
#include "common/messages/codec.hpp"
#include "common/messages/convert.hpp"
#include "import/rosbag/bag.hpp"
#include "import/rosbag/camera_image.hpp"
#include "import/rosbag/ros_messages.hpp"
#include "import/rosbag/static_frames.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <utility>
#include <vector>

namespace waymark {
namespace {

constexpr std::string_view kScanType = "sensor_msgs/LaserScan";
constexpr std::string_view kOdometryType = "nav_msgs/Odometry";
constexpr std::string_view kCompressedType = "sensor_msgs/CompressedImage";
constexpr std::string_view kImageType = "sensor_msgs/Image";
constexpr std::string_view kCameraInfoType = "sensor_msgs/CameraInfo";
constexpr std::string_view kTransformType = "tf2_msgs/TFMessage";
constexpr std::string_view kOldTransformType = "tf/tfMessage";
constexpr std::size_t kMaxBeams = 4000;  // as robot.lidar.num_beams
constexpr Duration kLongestSweep = std::chrono::seconds{10};

struct TopicContent {
  std::string type{};
  std::int64_t count{0};
};

using Topics = std::map<std::string, TopicContent>;

Topics topics_in(const std::filesystem::path& file, const std::filesystem::path& name) {
  Topics topics;
  ImportReport unread{name, AddressUnit::kByte};  // what is damaged is said when it is read
  read_bag(
      file,
      [&topics](const RosRecord& record) {
        TopicContent& content = topics[record.topic];
        content.type = record.type;
        ++content.count;
      },
      unread);
  return topics;
}

std::string list_of(const Topics& topics) {
  std::string text;
  for (const auto& [topic, content] : topics)
    text +=
        fmt::format("{}{} ({} {})", text.empty() ? "" : ", ", topic, content.count, content.type);
  return text.empty() ? "nothing" : text;
}

/// The topic that the user names, or the only one of these types; empty when there is none.
/// @throws SetupError when there are several, or the named one is not there.
std::string choose(const Topics& topics, const std::string& named, std::string_view option,
                   std::initializer_list<std::string_view> types) {
  Topics fitting;
  for (const auto& [topic, content] : topics) {
    if (std::ranges::find(types, content.type) != types.end()) fitting.emplace(topic, content);
  }
  if (!named.empty()) {
    if (fitting.contains(named)) return named;
    throw SetupError{fmt::format("{} {}: there is no such topic with {}; the bag holds {}", option,
                                 named, fmt::join(types, " or "), list_of(topics))};
  }
  if (fitting.size() > 1) {
    throw SetupError{
        fmt::format("say with {} which of several topics to take: {}", option, list_of(fitting))};
  }
  return fitting.empty() ? std::string{} : fitting.begin()->first;
}

std::string need(std::string topic, std::string_view type, const Topics& topics) {
  if (!topic.empty()) return topic;
  throw SetupError{fmt::format("the bag has no topic with {}; it holds {}", type, list_of(topics))};
}

/// Ranges as they are meant (REP-117): +inf = no return, NaN = no measurement.
float range_of(float range_m, const RosScan& scan) {
  if (std::isnan(range_m) || range_m <= 0.0F) return std::numeric_limits<float>::quiet_NaN();
  if (scan.range_max_m > 0.0F && range_m >= scan.range_max_m)
    return std::numeric_limits<float>::infinity();
  if (range_m < scan.range_min_m) return std::numeric_limits<float>::quiet_NaN();
  return range_m;
}

class RosbagReader {
 public:
  RosbagReader(const std::filesystem::path& file, const RosbagOptions& options,
               ImportReport& report)
      : options_{options}, report_{report}, topics_{topics_in(file, file.filename())} {
    scan_ =
        need(choose(topics_, options.scan_topic, "--scan-topic", {kScanType}), kScanType, topics_);
    odometry_ = need(choose(topics_, options.odometry_topic, "--odometry-topic", {kOdometryType}),
                     kOdometryType, topics_);
    if (options.without_images) return;
    image_ = choose(topics_, options.image_topic, "--image-topic", {kCompressedType, kImageType});
    if (image_.empty()) return;
    camera_info_ =
        choose(topics_, options.camera_info_topic, "--camera-info-topic", {kCameraInfoType});
  }

  void take(const RosRecord& record) {
    if (record.topic == scan_) {
      take_scan(record);
    } else if (record.topic == odometry_) {
      take_odometry(record);
    } else if (record.topic == image_) {
      take_image(record);
    } else if (record.topic == camera_info_) {
      take_camera_info(record);
    } else if (record.topic.ends_with("tf_static") &&
               (record.type == kTransformType || record.type == kOldTransformType)) {
      take_transforms(record);
    }
  }

  ImportedLog finish();

 private:
  void skip(std::string_view kind, const RosRecord& record) {
    report_.skip(kind, record.at, record.topic);
  }

  /// The stamp; where the driver sets none, the time of recording.
  Timestamp time_of(const RosHeader& header, const RosRecord& record) {
    if (header.stamp != Timestamp{}) return header.stamp;
    ++unstamped_[record.topic];
    return record.recorded;
  }

  void take_scan(const RosRecord& record);
  void take_odometry(const RosRecord& record);
  void take_image(const RosRecord& record);
  void take_camera_info(const RosRecord& record);
  void take_transforms(const RosRecord& record);
  void mount_lidar();
  void mount_camera();

  const RosbagOptions& options_;
  ImportReport& report_;
  Topics topics_;
  std::string scan_{};
  std::string odometry_{};
  std::string image_{};
  std::string camera_info_{};
  ImportedLog log_{};
  StaticFrames frames_{};
  std::string lidar_frame_{};
  std::string base_frame_{};
  std::string camera_frame_{};
  std::optional<RosCameraInfo> info_{};
  float range_min_m_{0.0F};
  float range_max_m_{0.0F};
  std::map<std::string, std::int64_t> unstamped_{};
};

void RosbagReader::take_scan(const RosRecord& record) {
  const auto scan = read_scan(record);
  if (!scan) return skip("bad scan message", record);
  if (scan->ranges_m.empty() || scan->ranges_m.size() > kMaxBeams) {
    return skip("too many beams, or none", record);
  }
  const Timestamp time = time_of(scan->header, record);
  ImportedScan imported{.time = time, .last_beam_time = time, .at = record.at};
  imported.num_beams = static_cast<int>(scan->ranges_m.size());
  const Duration step = duration_from_seconds(static_cast<double>(scan->time_increment_s));
  if (std::chrono::abs(step) * imported.num_beams > kLongestSweep)
    return skip("bad time increment", record);
  std::vector<float> ranges;
  for (const float range_m : scan->ranges_m) {
    ranges.push_back(range_of(range_m, *scan));
    if (std::isfinite(ranges.back()))
      imported.longest_range_m =
          std::max(imported.longest_range_m, static_cast<double>(ranges.back()));
  }
  if (scan->time_increment_s == 0.0F) {
    planar_lidar_t message{};
    message.utime = to_us(time);
    message.nranges = imported.num_beams;
    message.ranges = ranges;
    message.rad0 = scan->angle_min_rad;
    message.radstep = scan->angle_increment_rad;
    imported.message = encode(channels::kLidar, message);
  } else {
    lidar_t message{};
    message.utime = to_us(time);
    message.num_ranges = imported.num_beams;
    message.ranges = ranges;
    message.intensities.assign(ranges.size(), 0.0F);
    for (int i = 0; i < imported.num_beams; ++i) {
      message.thetas.push_back(
          -(scan->angle_min_rad + static_cast<float>(i) * scan->angle_increment_rad));
      const double offset_s = i * static_cast<double>(scan->time_increment_s);
      message.times.push_back(to_us(time + duration_from_seconds(offset_s)));
    }
    imported.last_beam_time = timestamp_from_us(std::ranges::max(message.times));
    imported.message = encode(channels::kMbotLidar, message);
  }
  lidar_frame_ = scan->header.frame;
  range_min_m_ = scan->range_min_m;
  if (std::isfinite(scan->range_max_m)) range_max_m_ = std::max(range_max_m_, scan->range_max_m);
  log_.scans.push_back(std::move(imported));
}

void RosbagReader::take_odometry(const RosRecord& record) {
  const auto odometry = read_odometry(record);
  if (!odometry) return skip("bad odometry message", record);
  constexpr double kFurthest = 1e6;  // [m] no odometry counts up to that
  if (odometry->pose.translation().norm() > kFurthest) return skip("absurd odometry", record);
  base_frame_ = odometry->child_frame;
  log_.odometry.push_back({time_of(odometry->header, record), record.at, odometry->pose});
}

void RosbagReader::take_image(const RosRecord& record) {
  const auto image = record.type == kImageType ? read_image(record) : read_compressed_image(record);
  if (!image) return skip("bad image message", record);
  const auto message = to_camera_message(*image, time_of(image->header, record));
  if (!message) return skip("image that cannot be decoded", record);
  camera_frame_ = image->header.frame;
  log_.images.push_back(encode(channels::kCamera, *message));
}

void RosbagReader::take_camera_info(const RosRecord& record) {
  auto info = read_camera_info(record);
  if (!info) return skip("bad camera info", record);
  info_ = std::move(info);
}

void RosbagReader::take_transforms(const RosRecord& record) {
  const auto transforms = read_transforms(record);
  if (!transforms) return skip("bad transforms", record);
  for (const RosTransform& transform : *transforms)
    frames_.add(transform);
}

void RosbagReader::mount_lidar() {
  LidarConfig& lidar = log_.robot.lidar;
  lidar.x_m = lidar.y_m = lidar.yaw_rad = 0.0;
  if (const auto base_from_lidar = frames_.find(base_frame_, lidar_frame_)) {
    const Eigen::Vector3d forward = base_from_lidar->linear().col(0);
    const Eigen::Vector3d up = base_from_lidar->linear().col(2);
    lidar.x_m = base_from_lidar->translation().x();
    lidar.y_m = base_from_lidar->translation().y();
    lidar.z_m = std::max(0.0, base_from_lidar->translation().z());
    lidar.yaw_rad = std::atan2(forward.y(), forward.x());
    constexpr double kUpright = 0.98;  // cosine of 11 degrees
    if (up.z() < kUpright) {
      report_.note(
          fmt::format("{} is not level in {} (upside down?): its beams are taken as if it were",
                      lidar_frame_, base_frame_));
    }
  } else {
    report_.note(fmt::format(
        "tf_static does not lead from {} to {}: the LiDAR counts as mounted at the origin; "
        "--lidar-x-m, --lidar-y-m, --lidar-yaw-deg and --base-frame say otherwise",
        base_frame_.empty() ? "the base" : base_frame_, lidar_frame_));
  }
  lidar.x_m = options_.mounting.x_m.value_or(lidar.x_m);
  lidar.y_m = options_.mounting.y_m.value_or(lidar.y_m);
  lidar.yaw_rad = options_.mounting.yaw_rad.value_or(lidar.yaw_rad);
  lidar.range_min_m = std::max(0.0F, range_min_m_);
  if (range_max_m_ > 0.0F) lidar.range_max_m = range_max_m_;
}

void RosbagReader::mount_camera() {
  CameraConfig& camera = log_.robot.camera;
  if (log_.images.empty()) return;
  if (info_ && info_->camera_matrix[0] > 0.0) {
    const auto& k = info_->camera_matrix;
    camera.width_px = info_->width_px;
    camera.height_px = info_->height_px;
    camera.fx_px = k[0];
    camera.cx_px = k[2];
    camera.fy_px = k[4];
    camera.cy_px = k[5];
    const bool is_known = info_->distortion_model == "plumb_bob" && info_->distortion.size() == 5;
    if (is_known) camera.distortion = info_->distortion;
    if (!is_known && !info_->distortion.empty()) {
      report_.note(fmt::format("the lens model '{}' is not known here: its distortion is left out",
                               info_->distortion_model));
    }
  } else {
    report_.note("no CameraInfo: the camera's focal length is a guess; edit [robot.camera]");
  }
  const auto base_from_optical = frames_.find(base_frame_, camera_frame_);
  if (!base_from_optical) {
    return report_.note(fmt::format(
        "tf_static does not lead from {} to {}: where the camera is mounted is a guess; edit "
        "[robot.camera]",
        base_frame_.empty() ? "the base" : base_frame_, camera_frame_));
  }
  camera.x_m = base_from_optical->translation().x();
  camera.y_m = base_from_optical->translation().y();
  camera.z_m = std::max(0.0, base_from_optical->translation().z());
  camera.roll_rad = camera.pitch_rad = camera.yaw_rad = 0.0;
  const Eigen::Matrix3d level = camera.base_from_camera().linear();  // optical axes of one that is
  const Eigen::Matrix3d turn = base_from_optical->linear() * level.transpose();
  camera.yaw_rad = std::atan2(turn(1, 0), turn(0, 0));
  camera.pitch_rad = std::atan2(-turn(2, 0), std::hypot(turn(2, 1), turn(2, 2)));
  camera.roll_rad = std::atan2(turn(2, 1), turn(2, 2));
}

ImportedLog RosbagReader::finish() {
  log_.contents = list_of(topics_);
  if (!options_.base_frame.empty()) base_frame_ = options_.base_frame;
  for (const auto& [topic, count] : unstamped_) {
    report_.note(fmt::format("{} messages of {} have no stamp: the time of recording is taken",
                             count, topic));
  }
  mount_lidar();
  mount_camera();
  complete(log_, report_);
  return std::move(log_);
}

}  // namespace

ImportedLog read_rosbag(const std::filesystem::path& file, const RosbagOptions& options,
                        ImportReport& report) {
  RosbagReader reader{file, options, report};
  read_bag(
      file, [&reader](const RosRecord& record) { reader.take(record); }, report);
  return reader.finish();
}

}  // namespace waymark
