// SPDX-License-Identifier: BSD-3-Clause
#include "import/carmen_reader.hpp"

#include "common/messages/codec.hpp"
#include "import/text_lines.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

namespace waymark {
namespace {

// A SICK LMS 200 reports 81.91 m when nothing returns (8191 in centimetres); it measures up to 80.
constexpr double kSickRangeMax_m = 81.9;

Timestamp timestamp_from_seconds(double seconds) {
  return Timestamp{duration_from_seconds(seconds)};
}

/// Written range -> REP-117: nothing within range_max = +inf; 0, which is no distance, = NaN.
double to_rep117(double range_m, double range_max_m) {
  if (range_m >= range_max_m) return std::numeric_limits<double>::infinity();
  return range_m == 0.0 ? std::numeric_limits<double>::quiet_NaN() : range_m;
}

class CarmenReader {
 public:
  CarmenReader(const CarmenOptions& options, ImportReport& report)
      : options_{options}, report_{report} {}

  void take(CarmenLine line, std::int64_t at) {
    at_ = at;
    std::visit([this](auto&& content) { take_content(std::forward<decltype(content)>(content)); },
               std::move(line));
  }

  ImportedLog finish();

 private:
  void take_content(const CarmenScan& scan);
  void take_content(const CarmenOdometry& odometry);

  void take_content(CarmenOther) { ++counts_["other lines"]; }

  void take_content(const LineProblem& problem) { report_.skip(problem.kind, at_, problem.detail); }

  void apply_mounting();
  bool mounting_is_constant() const;

  const CarmenOptions& options_;
  ImportReport& report_;
  ImportedLog log_{};
  std::int64_t at_{0};
  std::map<std::string, std::int64_t> counts_{};
  std::vector<Se2> base_from_lidar_{};   ///< of each scan
  std::optional<double> range_max_m_{};  ///< of the first scan
};

void CarmenReader::take_content(const CarmenScan& scan) {
  ++counts_[scan.lidar == CarmenLidar::kFront ? "front scans" : "rear scans"];
  if (scan.lidar != options_.lidar) return;
  const double range_max_m =
      options_.range_max_m.value_or(scan.range_max_m.value_or(kSickRangeMax_m));
  if (!range_max_m_) range_max_m_ = range_max_m;
  const Timestamp time = timestamp_from_seconds(scan.time_s);
  planar_lidar_t message{};
  message.utime = to_us(time);
  message.nranges = static_cast<int>(scan.ranges_m.size());
  message.rad0 = static_cast<float>(scan.first_angle_rad);
  message.radstep = static_cast<float>(scan.angle_step_rad);
  double longest_m = 0.0;
  for (const double written_m : scan.ranges_m) {
    const double range_m = to_rep117(written_m, range_max_m);
    message.ranges.push_back(static_cast<float>(range_m));
    if (std::isfinite(range_m)) longest_m = std::max(longest_m, range_m);
  }
  log_.scans.push_back(
      {time, time, at_, message.nranges, longest_m, encode(channels::kLidar, message), {}});
  if (options_.odometry == CarmenOdometrySource::kLaserLines) {
    log_.scans.back().odom_from_base = scan.odom_from_base;
  }
  base_from_lidar_.push_back(scan.odom_from_base.inverse() * scan.odom_from_lidar);
}

void CarmenReader::take_content(const CarmenOdometry& odometry) {
  ++counts_["ODOM"];
  if (options_.odometry != CarmenOdometrySource::kOdomLines) return;
  log_.odometry.push_back({timestamp_from_seconds(odometry.time_s), at_, odometry.odom_from_base});
}

/// A mounting is the same in (nearly) all lines; a log whose LiDAR poses were corrected has another
/// difference in each.
bool CarmenReader::mounting_is_constant() const {
  constexpr double kSame_m = 0.02;
  constexpr double kSame_rad = 0.02;
  constexpr double kNearlyAll = 0.95;  // single garbled numbers do not count
  const Se2 first = base_from_lidar_[base_from_lidar_.size() / 2];
  const auto num_same = std::ranges::count_if(base_from_lidar_, [&first](const Se2& other) {
    return (other.translation() - first.translation()).norm() < kSame_m &&
           std::abs(angle_difference(other.theta(), first.theta())) < kSame_rad;
  });
  return static_cast<double>(num_same) >= kNearlyAll * static_cast<double>(base_from_lidar_.size());
}

void CarmenReader::apply_mounting() {
  Se2 base_from_lidar{};
  if (!base_from_lidar_.empty()) {
    if (mounting_is_constant()) {
      base_from_lidar = base_from_lidar_[base_from_lidar_.size() / 2];
    } else {
      report_.note(
          "LiDAR and odometry poses differ by a changing amount (a corrected log?): the LiDAR is "
          "taken to sit at the base's origin; --lidar-x-m, --lidar-y-m, --lidar-yaw-deg say where");
    }
  }
  // Loggers write the robot's heading for the rear LiDAR, too, whose beam angles count from behind.
  if (options_.lidar == CarmenLidar::kRear && std::abs(base_from_lidar.theta()) < radians(90.0)) {
    base_from_lidar = base_from_lidar * Se2{0.0, 0.0, radians(180.0)};
  }
  LidarConfig& lidar = log_.robot.lidar;
  lidar.x_m = options_.mounting.x_m.value_or(base_from_lidar.x());
  lidar.y_m = options_.mounting.y_m.value_or(base_from_lidar.y());
  lidar.yaw_rad = options_.mounting.yaw_rad.value_or(base_from_lidar.theta());
}

ImportedLog CarmenReader::finish() {
  apply_mounting();
  log_.robot.lidar.range_min_m = options_.range_min_m;
  log_.robot.lidar.range_max_m = range_max_m_.value_or(kSickRangeMax_m);
  for (const auto& [name, count] : counts_) {
    log_.contents += fmt::format("{}{} {}", log_.contents.empty() ? "" : ", ", name, count);
  }
  if (!log_.scans.empty()) keep_usual_beam_count(log_.scans, report_);
  complete(log_, report_);
  return std::move(log_);
}

}  // namespace

ImportedLog read_carmen_log(const std::filesystem::path& file, const CarmenOptions& options,
                            ImportReport& report) {
  TextLines lines{file};
  CarmenReader reader{options, report};
  while (const auto line = lines.next())
    reader.take(parse_carmen_line(*line, options.beams), lines.line_number());
  if (!lines.fault().empty()) {
    report.skip("damaged file", lines.line_number(), "the file ends here: " + lines.fault());
  }
  return reader.finish();
}

}  // namespace waymark
