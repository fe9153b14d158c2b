// SPDX-License-Identifier: BSD-3-Clause
#include "import/carmen/odometry_lines.hpp"

#include "common/errors/setup_error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace waymark {
namespace {

constexpr double kOnePlace_m = 0.01;
constexpr double kOnePlace_rad = 0.02;
// There are two LiDARs if the second pose has at least so many scans and this share of all, and
// both poses together have nearly all scans.
constexpr std::ptrdiff_t kMinScans = 10;
constexpr double kMinShareOfSecond = 0.2;
constexpr double kMinShareOfBoth = 0.95;
constexpr double kMinStep_m = 0.02;  // shortest step that shows the direction of driving
constexpr double kMinDriven_m = 5.0;
// Mean |sin| of the angle between heading and direction of driving:
constexpr double kAligned = 0.3;     // largest mean |sin| if they agree
constexpr double kMisaligned = 0.5;  // least mean |sin| if they disagree; 2/pi if random

bool is_one_place(const Se2& a, const Se2& b) {
  return (a.translation() - b.translation()).norm() < kOnePlace_m &&
         std::abs(angle_difference(a.theta(), b.theta())) < kOnePlace_rad;
}

double share_of(std::ptrdiff_t count, std::size_t all) {
  return static_cast<double>(count) / static_cast<double>(all);
}

std::string place_text(const Se2& pose) {
  return fmt::format("x {:.2f} m, y {:.2f} m, yaw {:.0f} deg", pose.x(), pose.y(),
                     degrees(pose.theta()));
}

/// If the scans are of two LiDARs with different mounting poses, keeps the LiDAR with more scans.
void keep_the_more_frequent(std::vector<ReadScan>& scans, ImportReport& report) {
  const std::vector<Se2> poses = lidar_poses(scans);
  const Se2& first = poses.front();
  const auto other =
      std::ranges::find_if(poses, [&](const Se2& pose) { return !is_one_place(pose, first); });
  if (other == poses.end()) return;
  const auto of_first =
      std::ranges::count_if(poses, [&](const Se2& pose) { return is_one_place(pose, first); });
  const auto of_other =
      std::ranges::count_if(poses, [&](const Se2& pose) { return is_one_place(pose, *other); });
  if (std::min(of_first, of_other) < kMinScans ||
      share_of(std::min(of_first, of_other), poses.size()) < kMinShareOfSecond ||
      share_of(of_first + of_other, poses.size()) < kMinShareOfBoth) {
    return;
  }
  const Se2 kept = of_first >= of_other ? first : *other;
  const Se2 left = of_first >= of_other ? *other : first;
  report.note(fmt::format(
      "the scans are of two LiDARs under one keyword: {} scans from {}, {} from {}; the former are "
      "imported; for the latter, delete the lines of the former from a copy of the log",
      std::max(of_first, of_other), place_text(kept), std::min(of_first, of_other),
      place_text(left)));
  std::vector<ReadScan> of_kept;
  for (std::size_t i = 0; i < scans.size(); ++i)
    if (is_one_place(poses[i], kept)) of_kept.push_back(std::move(scans[i]));
  scans = std::move(of_kept);
}

bool differ(const std::vector<double>& a, const std::vector<double>& b) {
  return !std::equal(a.begin(), a.end(), b.begin(), b.end(), [](double one, double two) {
    return one == two || (std::isnan(one) && std::isnan(two));
  });
}

/// Reports pairs of different scans with equal stamps. Stamps of whole seconds are ignored: they
/// are equal by rounding.
void name_pairs(const std::vector<ReadScan>& scans, ImportReport& report) {
  std::ptrdiff_t pairs = 0;
  for (std::size_t i = 1; i < scans.size(); i += 2) {
    const ReadScan& one = scans[i - 1];
    const ReadScan& two = scans[i];
    const bool is_whole_second = one.line.time_s == std::floor(one.line.time_s);
    if (one.times.ipc == two.times.ipc && !is_whole_second &&
        differ(one.line.ranges_m, two.line.ranges_m))
      ++pairs;
  }
  if (scans.size() < 4 || share_of(2 * pairs, scans.size()) < 0.8) return;
  report.note(fmt::format(
      "{} scans come in pairs of one time: if they are of two LiDARs under one keyword, the map "
      "will be wrong; delete the lines of one from a copy of the log",
      2 * pairs));
}

template <class Line>
bool moves(const std::vector<ReadLine<Line>>& lines) {
  return std::ranges::any_of(lines, [&](const auto& read) {
    return !is_one_place(read.line.odom_from_base, lines.front().line.odom_from_base);
  });
}

}  // namespace

std::vector<Se2> lidar_poses(const std::vector<ReadScan>& scans) {
  std::vector<Se2> poses;
  for (const ReadScan& scan : scans)
    poses.push_back(scan.line.odom_from_base.inverse() * scan.line.odom_from_lidar);
  return poses;
}

void keep_one_lidar(std::vector<ReadScan>& scans, ImportReport& report) {
  const std::size_t all = scans.size();
  keep_the_more_frequent(scans, report);
  if (scans.size() == all) name_pairs(scans, report);
}

CarmenOdometrySource choose_odometry(const std::vector<ReadScan>& scans,
                                     const std::vector<ReadOdometry>& odometry,
                                     std::optional<CarmenOdometrySource> wanted,
                                     ImportReport& report) {
  if (wanted == CarmenOdometrySource::kOdomLines && odometry.empty()) {
    throw SetupError{
        "--odometry odom: the log has no ODOM line with a pose and a time; --odometry laser takes "
        "the poses in the LiDAR's lines"};
  }
  if (wanted) return *wanted;
  if (moves(scans) || odometry.empty() || !moves(odometry))
    return CarmenOdometrySource::kLaserLines;
  report.note(
      "the odometry in the scans' lines never moves, that of the ODOM lines does: the latter is "
      "taken; --odometry laser says otherwise");
  return CarmenOdometrySource::kOdomLines;
}

void check_headings(const std::vector<ReadScan>& scans) {
  double driven_m = 0.0;
  // Motion across the heading, if the headings are radians, and if they are degrees.
  double across_m = 0.0;
  double across_degrees_m = 0.0;
  for (std::size_t i = 1; i < scans.size(); ++i) {
    const CarmenScan& now = scans[i].line;
    const Eigen::Vector2d step =
        now.odom_from_base.translation() - scans[i - 1].line.odom_from_base.translation();
    if (step.norm() < kMinStep_m) continue;
    const double drive_rad = std::atan2(step.y(), step.x());
    driven_m += step.norm();
    across_m += step.norm() * std::abs(std::sin(drive_rad - now.heading_rad));
    across_degrees_m += step.norm() * std::abs(std::sin(drive_rad - radians(now.heading_rad)));
  }
  if (driven_m < kMinDriven_m || across_m < kMisaligned * driven_m ||
      across_degrees_m > kAligned * driven_m) {
    return;
  }
  throw SetupError{
      "the robot drives where odometry's headings point as degrees, not as radians: give "
      "--heading-unit deg"};
}

}  // namespace waymark
