// SPDX-License-Identifier: BSD-3-Clause
#include "import/carmen/carmen_reader.hpp"

#include "common/errors/setup_error.hpp"
#include "common/geometry/median.hpp"
#include "common/messages/bounds.hpp"
#include "common/messages/codec.hpp"
#include "import/carmen/line_times.hpp"
#include "import/carmen/mounting.hpp"
#include "import/carmen/odometry_lines.hpp"
#include "import/carmen/text_lines.hpp"
#include "import/findings/no_return.hpp"
#include "import/log/time_order.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

namespace waymark {
namespace {

// A SICK LMS 200 measures up to 80 m; from 8183 on, in centimetres, its values are error codes
// (SICK, Telegrams for configuring and operating the LMS 2xx).
constexpr double kSickRangeMax_m = 81.83;
constexpr double kFarthest_m = 150.0;    // largest plausible median of the ranges
constexpr double kNearestLimit_m = 2.0;  // no LiDAR's maximum range is shorter
constexpr double kCommonShare = 0.05;    // least share of the scans, as in keep_usual_beam_count()

Timestamp timestamp_from_seconds(double seconds) {
  return Timestamp{duration_from_seconds(seconds)};
}

template <class Line>
CarmenTimes line_times(const Line& line) {
  return {timestamp_from_seconds(line.time_s), timestamp_from_seconds(line.logger_time_s)};
}

constexpr std::size_t kScansForAngles = 300;  // largest number of scans examined

/// Ranges of scans with the same number of beams.
using SameSize = std::vector<std::span<const double>>;

class CarmenReader {
 public:
  CarmenReader(const CarmenOptions& options, ImportReport& report)
      : options_{options}, report_{report} {}

  void add(CarmenLine line, std::int64_t at) {
    at_ = at;
    std::visit([this](auto&& content) { add_content(std::forward<decltype(content)>(content)); },
               std::move(line));
  }

  ImportedLog finish();

 private:
  void add_content(CarmenScan scan);
  void add_content(const CarmenOdometry& odometry);

  void add_content(const CarmenMounting& mounting) { mountings_.push_back(mounting); }

  void add_content(CarmenOther other) { ++counts_[std::string{other.keyword}]; }

  void add_content(const LineProblem& problem) { report_.skip(problem.kind, at_, problem.detail); }

  void apply_stamps();
  void note_assumptions();
  std::optional<BeamAngles> angles_of(std::size_t num_beams, const SameSize& scans) const;
  void note_angles(std::size_t num_beams, const BeamAngles& angles);
  void complete_angles();
  std::string what_is_not_read() const;
  void add_scan(const ReadScan& read);
  void apply_mounting();
  double usual_range_max_m() const;
  void note_untimed_odometry();

  const CarmenOptions& options_;
  ImportReport& report_;
  ImportedLog log_{};
  std::int64_t at_{0};
  std::map<std::string, std::int64_t> counts_{};
  std::vector<ReadScan> scans_{};
  std::vector<ReadOdometry> odometry_{};
  std::vector<std::int64_t> untimed_odometry_{};  ///< line numbers
  CarmenOdometrySource source_{CarmenOdometrySource::kLaserLines};
  std::vector<CarmenMounting> mountings_{};
};

void CarmenReader::add_content(CarmenScan scan) {
  ++counts_[scan.lidar == CarmenLidar::kFront ? "front scans" : "rear scans"];
  if (scan.lidar != options_.lidar) return;
  for (double& range : scan.ranges_m)
    range *= options_.range_unit_m;
  scans_.push_back({line_times(scan), at_, std::move(scan), {}});
}

void CarmenReader::add_content(const CarmenOdometry& odometry) {
  ++counts_["ODOM"];
  if (odometry.num_times > 0) {
    odometry_.push_back({line_times(odometry), at_, odometry, {}});
  } else {
    untimed_odometry_.push_back(at_);
  }
}

void CarmenReader::apply_stamps() {
  std::vector<CarmenTimes> times;
  for (const auto& scan : scans_)
    times.push_back(scan.times);
  const CarmenStamps stamps = choose_stamps(times, options_.stamps, report_);
  for (auto& scan : scans_)
    scan.time = scan.times.by(stamps);
  for (auto& sample : odometry_)
    sample.time = sample.times.by(stamps);
  repair_order(scans_, odometry_, report_);
  for (const ReadOdometry& sample : odometry_)
    log_.odometry.push_back({sample.time, sample.at, sample.line.odom_from_base});
}

void CarmenReader::add_scan(const ReadScan& read) {
  const CarmenScan& scan = read.line;
  planar_lidar_t message{};
  message.utime = to_us(read.time);
  message.nranges = static_cast<int>(scan.ranges_m.size());
  message.rad0 = static_cast<float>(scan.angles->first_rad);
  message.radstep = static_cast<float>(scan.angles->step_rad);
  for (const double range_m : scan.ranges_m)
    message.ranges.push_back(static_cast<float>(std::min(range_m, bounds::kRange_m)));
  log_.scans.push_back(
      {read.time, read.time, read.at, message.nranges, 0.0, encode(channels::kLidar, message), {}});
  if (source_ == CarmenOdometrySource::kLaserLines)
    log_.scans.back().odom_from_base = scan.odom_from_base;
}

void CarmenReader::apply_mounting() {
  Se2 base_from_lidar = find_mounting(lidar_poses(scans_), mountings_, options_.lidar, report_);
  // Loggers write the robot's heading also for the rear LiDAR, whose beam angles count from behind.
  if (options_.lidar == CarmenLidar::kRear && std::abs(base_from_lidar.theta()) < radians(90.0)) {
    base_from_lidar = base_from_lidar * Se2{0.0, 0.0, radians(180.0)};
  }
  // Poses in the lines have six decimals.
  const auto rounded = [](double value) {
    return std::round(value * 1e6) / 1e6;
  };
  LidarConfig& lidar = log_.robot.lidar;
  lidar.x_m = options_.mounting.x_m.value_or(rounded(base_from_lidar.x()));
  lidar.y_m = options_.mounting.y_m.value_or(rounded(base_from_lidar.y()));
  lidar.yaw_rad = options_.mounting.yaw_rad.value_or(base_from_lidar.theta());
}

/// Median maximum range of the lines; a SICK's for lines without one. If it would be too short in
/// the ranges' unit, it is in metres.
double CarmenReader::usual_range_max_m() const {
  const auto limit_m = [this](const CarmenScan& scan) {
    if (!scan.range_max_m) return kSickRangeMax_m;
    const double in_unit_m = *scan.range_max_m * options_.range_unit_m;
    return in_unit_m < kNearestLimit_m ? *scan.range_max_m : in_unit_m;
  };
  std::vector<double> limits_m;
  for (const auto& scan : scans_)
    limits_m.push_back(limit_m(scan.line));
  return upper_median(std::move(limits_m));
}

std::string CarmenReader::what_is_not_read() const {
  const bool is_front = options_.lidar == CarmenLidar::kFront;
  if (counts_.contains(is_front ? "rear scans" : "front scans"))
    return fmt::format(": give --lidar {}", is_front ? "rear" : "front");
  if (report_.skipped_by_kind().contains("bad time"))
    return ": the times of its lines are none: if they are milliseconds or microseconds, give "
           "--time-unit ms or us";
  if (std::ranges::any_of(counts_,
                          [](const auto& entry) { return entry.first.starts_with("RAWLASER"); }))
    return ": RAWLASER lines, which have no odometry, are not read; write them as ROBOTLASER1";
  return "";
}

/// Reports ranges that count as not measured.
/// @throws SetupError for ranges that are not metres.
void CarmenReader::note_assumptions() {
  std::int64_t no_ranges = 0;
  std::vector<double> ranges_m;
  for (const auto& scan : scans_) {
    no_ranges += scan.line.num_no_ranges;
    for (const double range_m : scan.line.ranges_m)
      if (std::isfinite(range_m)) ranges_m.push_back(range_m);
  }
  if (no_ranges > 0)
    report_.note(fmt::format("{} ranges are negative or NaN: taken as not measured", no_ranges));
  if (ranges_m.empty() || options_.range_max_m) return;
  const double longest_m = std::ranges::max(ranges_m);
  if (longest_m > kFarthest_m &&
      std::ranges::all_of(ranges_m, [](double r) { return r == std::floor(r); })) {
    throw SetupError{fmt::format(
        "all ranges are whole numbers, up to {:g}: are they in cm or mm? Give --range-unit cm or "
        "mm, or --max-range-m if they are metres",
        longest_m)};
  }
  const double usual_m = upper_median(std::move(ranges_m));
  if (usual_m > kFarthest_m) {
    throw SetupError{fmt::format(
        "half of the ranges are above {:g} m: are they in cm or mm? Give --range-unit cm or mm, "
        "or --max-range-m if they are metres",
        usual_m)};
  }
}

/// The angles that the user gives, else those that the walls show; nullopt if they are unknown.
std::optional<BeamAngles> CarmenReader::angles_of(std::size_t num_beams,
                                                  const SameSize& scans) const {
  const auto& [given_first_rad, given_step_rad] = options_.beams;
  std::optional<BeamAngles> angles;
  if (given_step_rad) {
    angles = {first_angle_rad(num_beams, *given_step_rad), *given_step_rad};
  } else {
    SameSize some;
    for (std::size_t i = 0; i < scans.size(); i += 1 + scans.size() / kScansForAngles)
      some.push_back(scans[i]);
    angles = straightest_angles(some, num_beams);
  }
  if (angles && given_first_rad) angles->first_rad = *given_first_rad;
  return angles;
}

void CarmenReader::note_angles(std::size_t num_beams, const BeamAngles& angles) {
  const auto& [given_first_rad, given_step_rad] = options_.beams;
  if (given_first_rad && given_step_rad) return;
  const auto usual = conventional_angles(num_beams);
  const bool is_usual = usual && usual->step_rad == angles.step_rad;
  report_.note(fmt::format(
      "the lines do not say the beams' angles: {} beams of {:g} degrees from {:g} are {} "
      "(--first-angle-deg, --angle-step-deg)",
      num_beams, degrees(angles.step_rad), degrees(angles.first_rad),
      is_usual || given_step_rad ? "assumed" : "taken, with which walls are straight"));
}

/// Sets the angles of lines without them, for each number of beams. A number that differs by one
/// from the most frequent one gets its angles, and so does a rare number whose angles are unknown.
/// @throws SetupError when they are unknown.
void CarmenReader::complete_angles() {
  std::map<std::size_t, SameSize> scans_by_size;
  for (const auto& scan : scans_)
    if (!scan.line.angles)
      scans_by_size[scan.line.ranges_m.size()].emplace_back(scan.line.ranges_m);
  if (scans_by_size.empty()) return;
  const std::size_t usual = std::ranges::max_element(scans_by_size, {}, [](const auto& some) {
                              return some.second.size();
                            })->first;
  std::map<std::size_t, BeamAngles> angles_by_size;
  for (const auto& [num_beams, scans] : scans_by_size) {
    if (num_beams + 1 == usual || num_beams == usual + 1) continue;
    const auto angles = angles_of(num_beams, scans);
    const bool is_common =
        num_beams == usual ||
        static_cast<double>(scans.size()) >= kCommonShare * static_cast<double>(scans_.size());
    if (!angles && is_common) {
      throw SetupError{fmt::format(
          "the lines do not say the angles of their {} beams, and walls do not show them: give "
          "--first-angle-deg and --angle-step-deg",
          num_beams)};
    }
    if (angles) angles_by_size.emplace(num_beams, *angles);
    if (is_common) note_angles(num_beams, *angles);
  }
  for (auto& scan : scans_) {
    if (scan.line.angles) continue;
    const auto found = angles_by_size.find(scan.line.ranges_m.size());
    scan.line.angles = found == angles_by_size.end() ? angles_by_size.at(usual) : found->second;
  }
}

void CarmenReader::note_untimed_odometry() {
  if (untimed_odometry_.empty()) return;
  report_.note(fmt::format("{} ODOM lines have no times, the first is line {}: they are not used",
                           untimed_odometry_.size(), untimed_odometry_.front()));
}

ImportedLog CarmenReader::finish() {
  for (const auto& [name, count] : counts_) {
    log_.contents += fmt::format("{}{} {}", log_.contents.empty() ? "" : ", ", name, count);
  }
  if (scans_.empty()) {
    if (report_.skipped_by_kind().contains("unknown line") &&
        std::ranges::all_of(counts_,
                            [](const auto& entry) { return entry.first == CarmenOther{}.keyword; }))
      throw NotACarmenLog{"it is no CARMEN log: no line begins with one of its keywords"};
    throw SetupError{"no LiDAR scan could be read" +
                     (log_.contents.empty() ? "" : "; the log holds " + log_.contents) +
                     what_is_not_read()};
  }
  note_assumptions();
  complete_angles();
  complete_times(scans_, options_.scan_period_s, report_);
  keep_one_lidar(scans_, report_);
  note_untimed_odometry();
  source_ = choose_odometry(scans_, odometry_, options_.odometry, report_);
  if (source_ == CarmenOdometrySource::kLaserLines) odometry_.clear();
  check_headings(scans_);
  apply_stamps();
  remove_absurd_times(scans_, "a scan", report_);
  remove_absurd_times(log_.odometry, "odometry", report_);
  check_time_unit(scans_, report_);
  apply_mounting();
  restore_order(scans_, "scan", report_);
  spread_equal_stamps(scans_, "scan", report_);
  restore_order(log_.odometry, "odometry sample", report_);
  spread_equal_stamps(log_.odometry, "odometry sample", report_);
  for (const auto& scan : scans_)
    add_scan(scan);
  keep_usual_beam_count(log_.scans, report_);
  log_.robot.lidar.range_min_m = options_.range_min_m;
  make_consistent(log_, report_);
  mark_no_returns(log_, {options_.range_max_m, usual_range_max_m()}, report_);
  return std::move(log_);
}

}  // namespace

ImportedLog read_carmen_log(const std::filesystem::path& file, const CarmenOptions& options,
                            ImportReport& report) {
  TextLines lines{file};
  CarmenReader reader{options, report};
  while (const auto line = lines.next())
    reader.add(parse_carmen_line(*line, options.beams, options.units), lines.line_number());
  if (!lines.fault().empty()) {
    report.skip("damaged file", lines.line_number(), "the file ends here: " + lines.fault());
  }
  return reader.finish();
}

}  // namespace waymark
