// SPDX-License-Identifier: BSD-3-Clause
#include "import/rosbag/rosbag_reader.hpp"

#include "common/errors/setup_error.hpp"
#include "common/geometry/median.hpp"
#include "common/messages/bounds.hpp"
#include "common/messages/codec.hpp"
#include "common/messages/validate.hpp"
#include "import/findings/no_return.hpp"
#include "import/rosbag/bag.hpp"
#include "import/rosbag/camera_image.hpp"
#include "import/rosbag/mounting.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
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

struct TopicContent {
  std::string type{};
  std::int64_t count{0};
};

using Topics = std::map<std::string, TopicContent>;

Topics topics_in(const std::filesystem::path& file) {
  Topics topics;
  ImportReport unread{file, AddressUnit::kByte};  // damage is reported in the second pass
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
  for (const auto& [topic, content] : topics) {
    text +=
        fmt::format("{}{} ({} {})", text.empty() ? "" : ", ", topic, content.count, content.type);
  }
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

class RosbagReader {
 public:
  RosbagReader(const std::filesystem::path& file, const RosbagOptions& options,
               ImportReport& report)
      : options_{options}, report_{report}, topics_{topics_in(file)} {
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

  void add(const RosRecord& record) {
    if (record.topic == scan_) {
      add_scan(record);
    } else if (record.topic == odometry_) {
      add_odometry(record);
    } else if (record.topic == image_) {
      add_image(record);
    } else if (record.topic == camera_info_) {
      add_camera_info(record);
    } else if (record.type == kTransformType || record.type == kOldTransformType) {
      add_transforms(record);
    }
  }

  ImportedLog finish();

 private:
  struct HeldScan {
    Timestamp time{};
    std::int64_t at{0};
    RosScan scan{};
  };

  void skip(std::string_view kind, const RosRecord& record) {
    report_.skip(kind, record.at, record.topic);
  }

  /// The header's stamp; the time of recording if the driver sets none.
  Timestamp time_of(const RosHeader& header, const RosRecord& record) {
    if (header.stamp != Timestamp{}) return header.stamp;
    ++unstamped_[record.topic];
    return record.recorded;
  }

  void add_scan(const RosRecord& record);
  void add_odometry(const RosRecord& record);
  void add_image(const RosRecord& record);
  void add_camera_info(const RosRecord& record);
  void add_transforms(const RosRecord& record);
  void add_scans(LidarOrientation orientation);
  void note_zeros();
  std::optional<double> usual_range_max_m() const;

  const RosbagOptions& options_;
  ImportReport& report_;
  Topics topics_;
  std::string scan_{};
  std::string odometry_{};
  std::string image_{};
  std::string camera_info_{};
  ImportedLog log_{};
  std::vector<HeldScan> scans_{};  // kept until it is known whether the LiDAR is upside down
  StaticFrames transforms_{};
  SensorFrames frames_{};
  std::optional<RosCameraInfo> info_{};
  std::map<std::string, std::int64_t> unstamped_{};
};

void RosbagReader::add_scan(const RosRecord& record) {
  auto scan = read_scan(record);
  if (!scan) return skip("bad scan message", record);
  const Timestamp time = time_of(scan->header, record);
  frames_.lidar = scan->header.frame;
  scans_.push_back({time, record.at, std::move(*scan)});
}

void RosbagReader::add_odometry(const RosRecord& record) {
  const auto odometry = read_odometry(record);
  if (!odometry) return skip("bad odometry message", record);
  if (odometry->pose.translation().cwiseAbs().maxCoeff() > bounds::kPosition_m)
    return skip("absurd odometry", record);
  frames_.base = odometry->child_frame;
  log_.odometry.push_back({time_of(odometry->header, record), record.at, odometry->pose});
}

void RosbagReader::add_image(const RosRecord& record) {
  const auto image = record.type == kImageType ? read_image(record) : read_compressed_image(record);
  if (!image) return skip("bad image message", record);
  const Timestamp time = time_of(image->header, record);
  if (!has_known_encoding(*image)) {
    return report_.skip("image of an encoding that is not read", record.at,
                        fmt::format("{}: '{}'", record.topic, image->format));
  }
  const auto message = to_camera_message(*image, time);
  if (!message) return skip("image that cannot be decoded", record);
  if (validate(*message) != RejectReason::kNone) return skip("absurd image", record);
  frames_.camera = image->header.frame;
  log_.images.push_back({time, record.at, encode(channels::kCamera, *message)});
}

void RosbagReader::add_camera_info(const RosRecord& record) {
  auto info = read_camera_info(record);
  if (!info) return skip("bad camera info", record);
  if (!info_) info_ = std::move(info);
}

void RosbagReader::add_transforms(const RosRecord& record) {
  const auto transforms = read_transforms(record);
  if (!transforms) return skip("bad transforms", record);
  const bool is_static = record.topic.ends_with("tf_static");
  for (const std::string& child : transforms->bad) {
    skip("bad transform of " + child, record);
  }
  for (const RosTransform& transform : transforms->good) {
    transforms_.add(transform, is_static ? TransformSource::kStatic : TransformSource::kRepeated);
  }
}

void RosbagReader::add_scans(LidarOrientation orientation) {
  for (const HeldScan& held : scans_) {
    RosScanResult result = to_imported_scan(held.scan, held.time, held.at, orientation);
    if (const auto* problem = std::get_if<LineProblem>(&result)) {
      report_.skip(problem->kind, held.at, scan_ + ": " + problem->detail);
    } else {
      log_.scans.push_back(std::move(std::get<ImportedScan>(result)));
    }
  }
}

void RosbagReader::note_zeros() {
  std::int64_t zeros = 0;
  std::int64_t ranges = 0;
  for (const HeldScan& held : scans_) {
    ranges += std::ssize(held.scan.ranges_m);
    zeros += std::ranges::count(held.scan.ranges_m, 0.0F);
  }
  if (zeros == 0) return;
  report_.note(fmt::format("ranges of 0 m ({} of {}, {:.2f} %): taken for not measured", zeros,
                           ranges,
                           100.0 * static_cast<double>(zeros) / static_cast<double>(ranges)));
}

/// Median of the scans' range_max; nullopt if that is 0 or infinite.
std::optional<double> RosbagReader::usual_range_max_m() const {
  std::vector<double> limits_m;
  for (const HeldScan& held : scans_)
    limits_m.push_back(double{held.scan.range_max_m});
  const double limit_m = upper_median(std::move(limits_m));
  return limit_m > 0.0 && std::isfinite(limit_m) ? std::optional{limit_m} : std::nullopt;
}

ImportedLog RosbagReader::finish() {
  log_.contents = list_of(topics_);
  if (!options_.base_frame.empty()) frames_.base = options_.base_frame;
  for (const auto& [topic, count] : unstamped_) {
    report_.note(fmt::format("{} messages of {} have no stamp: the time of recording is taken",
                             count, topic));
  }
  RobotConfig& robot = log_.robot;
  add_scans(describe_lidar(robot.lidar, transforms_, frames_, options_.mounting, report_));
  make_consistent(log_, report_);
  note_zeros();
  std::vector<double> shortest_m;
  for (const HeldScan& held : scans_)
    shortest_m.push_back(double{held.scan.range_min_m});
  robot.lidar.range_min_m = std::max(0.0, upper_median(std::move(shortest_m)));
  mark_no_returns(log_, {options_.range_max_m, usual_range_max_m()}, report_);
  if (!log_.images.empty()) {
    const bool is_rectified = image_.find("image_rect") != std::string::npos;
    describe_camera(robot.camera, transforms_, frames_, info_, log_.images.front(),
                    is_rectified ? ImageRectification::kRectified : ImageRectification::kRaw,
                    report_);
  }
  return std::move(log_);
}

}  // namespace

ImportedLog read_rosbag(const std::filesystem::path& file, const RosbagOptions& options,
                        ImportReport& report) {
  RosbagReader reader{file, options, report};
  read_bag(
      file, [&reader](const RosRecord& record) { reader.add(record); }, report);
  return reader.finish();
}

}  // namespace waymark
