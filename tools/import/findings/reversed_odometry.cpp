// SPDX-License-Identifier: BSD-3-Clause
#include "import/findings/reversed_odometry.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

namespace waymark {
namespace {

constexpr double kShortest_m = 0.02;     // of a step: less is noise
constexpr double kLongest_m = 1.0;       // more, and too little of the two scans overlaps
constexpr double kLargestError_m = 0.3;  // of a beam: more is something else than the same wall
constexpr double kSameWall_m = 0.3;      // between ranges that are interpolated
constexpr std::size_t kFewestBeams = 30;
constexpr double kClearly = 0.6;  // error of the better direction over that of the other one
constexpr int kVotes_each_side = 2;

enum class Direction { kUnclear, kAsCounted, kReversed };

/// The scan's range in a direction [rad], interpolated; nothing at edges, gaps and outside.
/// @param scan  angles ascending
std::optional<double> range_towards(const LidarScan& scan, double angle_rad) {
  const auto after = std::ranges::upper_bound(scan.angles_rad, angle_rad);
  if (after == scan.angles_rad.begin() || after == scan.angles_rad.end()) return std::nullopt;
  const auto i = static_cast<std::size_t>(after - scan.angles_rad.begin());
  const double low_m = scan.ranges_m[i - 1];
  const double high_m = scan.ranges_m[i];
  if (!std::isfinite(low_m) || !std::isfinite(high_m) || std::abs(high_m - low_m) > kSameWall_m)
    return std::nullopt;
  const double share =
      (angle_rad - scan.angles_rad[i - 1]) / (scan.angles_rad[i] - scan.angles_rad[i - 1]);
  return low_m + share * (high_m - low_m);
}

/// Mean absolute difference between the first scan and the second one as seen from the first [m].
std::optional<double> misfit_m(const LidarScan& first, const LidarScan& second,
                               const Se2& first_from_second) {
  double sum_m = 0.0;
  std::size_t count = 0;
  for (std::size_t i = 0; i < second.ranges_m.size(); ++i) {
    const double range_m = second.ranges_m[i];
    if (!std::isfinite(range_m)) continue;
    const Eigen::Vector2d end =
        first_from_second * Eigen::Vector2d{range_m * std::cos(second.angles_rad[i]),
                                            range_m * std::sin(second.angles_rad[i])};
    const auto expected_m = range_towards(first, std::atan2(end.y(), end.x()));
    if (!expected_m) continue;
    sum_m += std::min(std::abs(*expected_m - end.norm()), kLargestError_m);
    ++count;
  }
  if (count < kFewestBeams) return std::nullopt;
  return sum_m / static_cast<double>(count);
}

Direction direction_of(const LidarScan& first, const LidarScan& second, const Se2& motion,
                       const Se2& base_from_lidar) {
  const double distance_m = motion.translation().norm();
  if (distance_m < kShortest_m || distance_m > kLongest_m) return Direction::kUnclear;
  const auto misfit_with = [&](const Se2& moved) {
    return misfit_m(first, second, base_from_lidar.inverse() * moved * base_from_lidar);
  };
  const auto counted_m = misfit_with(motion);
  const auto reversed_m = misfit_with(Se2{-motion.translation(), motion.theta()});
  if (!counted_m || !reversed_m) return Direction::kUnclear;
  if (*reversed_m < kClearly * *counted_m) return Direction::kReversed;
  if (*counted_m < kClearly * *reversed_m) return Direction::kAsCounted;
  return Direction::kUnclear;
}

/// The pose at a time within the poses' span, interpolated.
Se2 pose_at(const std::vector<ImportedPose>& poses, Timestamp time) {
  const auto after = std::ranges::lower_bound(poses, time, {}, &ImportedPose::time);
  if (after == poses.begin()) return after->pose;
  const auto before = std::prev(after);
  if (after == poses.end()) return before->pose;
  const double share = to_seconds(time - before->time) / to_seconds(after->time - before->time);
  const Se2 step = before->pose.inverse() * after->pose;
  return before->pose * Se2{share * step.translation(), share * step.theta()};
}

LidarScan with_ascending_angles(LidarScan scan) {
  if (scan.angles_rad.size() > 1 && scan.angles_rad.front() > scan.angles_rad.back()) {
    std::ranges::reverse(scan.angles_rad);
    std::ranges::reverse(scan.ranges_m);
  }
  return scan;
}

bool is_voted_reversed(const std::vector<Direction>& directions, std::size_t step) {
  const auto low = step - std::min<std::size_t>(step, kVotes_each_side);
  const auto high = std::min(directions.size(), step + kVotes_each_side + 1);
  const auto begin = directions.begin() + static_cast<std::ptrdiff_t>(low);
  const auto end = directions.begin() + static_cast<std::ptrdiff_t>(high);
  const auto reversed = std::count(begin, end, Direction::kReversed);
  return reversed >= 2 && reversed > std::count(begin, end, Direction::kAsCounted);
}

}  // namespace

std::vector<ReversedStep> find_reversed_steps(const ImportedLog& log) {
  std::vector<Direction> directions;
  std::vector<ReversedStep> steps;
  LidarScan before = with_ascending_angles(scan_of(log.scans.front()));
  Se2 odom_from_before = pose_at(log.odometry, before.time);
  for (std::size_t i = 1; i < log.scans.size(); ++i) {
    LidarScan now = with_ascending_angles(scan_of(log.scans[i]));
    const Se2 odom_from_now = pose_at(log.odometry, now.time);
    const Se2 motion = odom_from_before.inverse() * odom_from_now;
    directions.push_back(direction_of(before, now, motion, log.robot.lidar.base_from_lidar()));
    steps.push_back({before.time, now.time, motion.translation().norm()});
    before = std::move(now);
    odom_from_before = odom_from_now;
  }
  std::vector<ReversedStep> reversed;
  for (std::size_t i = 0; i < steps.size(); ++i) {
    if (steps[i].distance_m > 0.0 && is_voted_reversed(directions, i)) reversed.push_back(steps[i]);
  }
  return reversed;
}

std::vector<ImportedPose> with_steps_mended(const std::vector<ImportedPose>& odometry,
                                            const std::vector<ReversedStep>& steps) {
  std::vector<ImportedPose> mended;
  auto step = steps.begin();
  for (std::size_t i = 0; i < odometry.size(); ++i) {
    mended.push_back(odometry[i]);
    if (i == 0) continue;
    while (step != steps.end() && step->until < odometry[i].time)
      ++step;
    Se2 motion = odometry[i - 1].pose.inverse() * odometry[i].pose;
    if (step != steps.end() && odometry[i].time > step->after)
      motion = Se2{-motion.translation(), motion.theta()};
    mended[i].pose = mended[i - 1].pose * motion;
  }
  return mended;
}

}  // namespace waymark
