// SPDX-License-Identifier: BSD-3-Clause
#include "import/carmen/carmen_reader.hpp"

#include "common/messages/codec.hpp"
#include "import/carmen/text_lines.hpp"
#include "import/findings/range_codes.hpp"
#include "import/log/time_order.hpp"

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
constexpr Duration kLongestBurst = std::chrono::milliseconds{1};

Timestamp timestamp_from_seconds(double seconds) {
  return Timestamp{duration_from_seconds(seconds)};
}

/// Written range -> REP-117: nothing within range_max = +inf; 0, which is no distance, = NaN.
double to_rep117(double range_m, double range_max_m) {
  if (range_m >= range_max_m) return std::numeric_limits<double>::infinity();
  return range_m == 0.0 ? std::numeric_limits<double>::quiet_NaN() : range_m;
}

struct ReadScan {
  Timestamp time{};
  std::int64_t at{0};
  CarmenScan line{};
};

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
  void take_content(CarmenScan scan);
  void take_content(const CarmenOdometry& odometry);

  void take_content(const CarmenMounting& mounting) { mountings_.push_back(mounting); }

  void take_content(CarmenOther) { ++counts_["other lines"]; }

  void take_content(const LineProblem& problem) { report_.skip(problem.kind, at_, problem.detail); }

  double range_max_m();
  void part_equal_times();
  void add_scan(const ReadScan& read, double range_max_m);
  void apply_mounting();
  std::optional<Se2> mounting_of_poses() const;
  std::optional<Se2> mounting_of_parameters() const;

  const CarmenOptions& options_;
  ImportReport& report_;
  ImportedLog log_{};
  std::int64_t at_{0};
  std::map<std::string, std::int64_t> counts_{};
  std::vector<ReadScan> scans_{};
  std::vector<CarmenMounting> mountings_{};
  RangeHistogram histogram_{};
};

void CarmenReader::take_content(CarmenScan scan) {
  ++counts_[scan.lidar == CarmenLidar::kFront ? "front scans" : "rear scans"];
  if (scan.lidar != options_.lidar) return;
  histogram_.add(scan.ranges_m);
  scans_.push_back({timestamp_from_seconds(scan.time_s), at_, std::move(scan)});
}

/// From here on a range is no return: as configured, as the line says, or where ranges pile up.
double CarmenReader::range_max_m() {
  if (options_.range_max_m) return *options_.range_max_m;
  const double written_m =
      scans_.empty() ? kSickRangeMax_m : scans_.front().line.range_max_m.value_or(kSickRangeMax_m);
  const auto code = histogram_.no_return_code();
  if (!code || code->range_m >= written_m) return written_m;
  report_.note(
      fmt::format("{} ranges ({:.2f} %) are {:.2f} m or more, next to none just below: taken for "
                  "no return; --max-range-m says otherwise",
                  code->count, 100.0 * code->share, code->range_m));
  return code->range_m;
}

/// Scans that a driver stamps alike because it sends them in a burst: order is kept, and each one
/// gets the next microsecond, so that none is taken for a repetition.
void CarmenReader::part_equal_times() {
  std::int64_t parted = 0;
  for (std::size_t i = 1; i < scans_.size(); ++i) {
    const Timestamp before = scans_[i - 1].time;
    const Timestamp as_written = timestamp_from_seconds(scans_[i].line.time_s);
    // Only right behind scans of the same stamp; a larger step back is another fault.
    if (scans_[i].time > before || before - as_written > kLongestBurst) continue;
    scans_[i].time = before + std::chrono::microseconds{1};
    ++parted;
  }
  if (parted > 0)
    report_.note(fmt::format("{} scans have the time of the one before: stamped 1 us apart",
                             parted));
}

void CarmenReader::add_scan(const ReadScan& read, double range_max_m) {
  const CarmenScan& scan = read.line;
  planar_lidar_t message{};
  message.utime = to_us(read.time);
  message.nranges = static_cast<int>(scan.ranges_m.size());
  message.rad0 = static_cast<float>(scan.first_angle_rad);
  message.radstep = static_cast<float>(scan.angle_step_rad);
  double longest_m = 0.0;
  for (const double written_m : scan.ranges_m) {
    const double range_m = to_rep117(written_m, range_max_m);
    message.ranges.push_back(static_cast<float>(range_m));
    if (std::isfinite(range_m)) longest_m = std::max(longest_m, range_m);
  }
  log_.scans.push_back({read.time, read.time, read.at, message.nranges, longest_m,
                        encode(channels::kLidar, message), {}});
  if (options_.odometry == CarmenOdometrySource::kLaserLines) {
    log_.scans.back().odom_from_base = scan.odom_from_base;
  }
}

void CarmenReader::take_content(const CarmenOdometry& odometry) {
  ++counts_["ODOM"];
  if (options_.odometry != CarmenOdometrySource::kOdomLines) return;
  log_.odometry.push_back({timestamp_from_seconds(odometry.time_s), at_, odometry.odom_from_base});
}

/// A mounting is the same in (nearly) all lines; a log whose LiDAR poses were corrected has another
/// difference in each, and gives none.
std::optional<Se2> CarmenReader::mounting_of_poses() const {
  constexpr double kSame_m = 0.02;
  constexpr double kSame_rad = 0.02;
  constexpr double kNearlyAll = 0.95;  // single garbled numbers do not count
  const auto base_from_lidar = [](const ReadScan& scan) {
    return scan.line.odom_from_base.inverse() * scan.line.odom_from_lidar;
  };
  const Se2 middle = base_from_lidar(scans_[scans_.size() / 2]);
  const auto num_same = std::ranges::count_if(scans_, [&](const ReadScan& scan) {
    const Se2 other = base_from_lidar(scan);
    return (other.translation() - middle.translation()).norm() < kSame_m &&
           std::abs(angle_difference(other.theta(), middle.theta())) < kSame_rad;
  });
  const bool is_constant =
      static_cast<double>(num_same) >= kNearlyAll * static_cast<double>(scans_.size());
  return is_constant ? std::optional{middle} : std::nullopt;
}

std::optional<Se2> CarmenReader::mounting_of_parameters() const {
  if (mountings_.empty() || options_.lidar != CarmenLidar::kFront) return std::nullopt;
  Eigen::Vector3d values = Eigen::Vector3d::Zero();
  for (const CarmenMounting& mounting : mountings_)
    values(static_cast<Eigen::Index>(mounting.what)) = mounting.value;
  return Se2{values(0), values(1), values(2)};
}

/// The poses of the lines say it, unless they are equal (a logger that did not know it) or vary:
/// then the parameters do.
void CarmenReader::apply_mounting() {
  constexpr double kEqual_m = 1e-3;
  Se2 base_from_lidar{};
  if (!scans_.empty()) {
    const auto of_poses = mounting_of_poses();
    const auto of_parameters = mounting_of_parameters();
    const bool poses_say_nothing = !of_poses || of_poses->translation().norm() < kEqual_m;
    base_from_lidar = of_poses.value_or(Se2{});
    if (of_parameters && poses_say_nothing) {
      base_from_lidar = *of_parameters;
      report_.note(
          fmt::format("LiDAR mounting taken from the PARAM lines: x {:.3f} m, y {:.3f} m, yaw "
                      "{:.2f} deg; --lidar-x-m, --lidar-y-m, --lidar-yaw-deg say otherwise",
                      base_from_lidar.x(), base_from_lidar.y(), degrees(base_from_lidar.theta())));
    } else if (!of_poses) {
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
  settle_small_disorder(scans_, "scan", report_);
  part_equal_times();
  log_.robot.lidar.range_min_m = options_.range_min_m;
  log_.robot.lidar.range_max_m = range_max_m();
  for (const ReadScan& scan : scans_)
    add_scan(scan, log_.robot.lidar.range_max_m);
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
