// SPDX-License-Identifier: BSD-3-Clause
#include "import/findings/motion_fit.hpp"

#include "import/findings/scan_overlay.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <span>

namespace waymark {
namespace {

constexpr std::size_t kPairs = 240;  // largest number, spread evenly over the log
constexpr std::size_t kMinPairs = 40;
constexpr Duration kApart = std::chrono::milliseconds{800};  // at least, between a pair's scans
constexpr double kNoOverlap_m = 0.3;  // counts as the misfit of a pair that does not overlap

/// Two scans, in order of angles, and odometry's motion between them.
struct Pair {
  LidarScan before{};
  LidarScan now{};
  Se2 motion{};
};

/// Limits on odometry's motion between the scans of a pair.
struct MotionLimits {
  double least_m{0.0};
  double most_m{0.0};
  double most_rad{0.0};
  double least_rad{0.0};
};

std::vector<Pair> pairs_of(const ImportedLog& log, const BodyBeams& body,
                           const MotionLimits& limits) {
  std::vector<std::pair<std::size_t, std::size_t>> found;
  for (std::size_t before = 0, now = 1; now < log.scans.size(); ++now) {
    if (log.scans[now].time - log.scans[before].time < kApart) continue;
    const Se2 motion = odometry_between(log, before, now);
    const double distance_m = motion.translation().norm();
    if (distance_m >= limits.least_m && distance_m <= limits.most_m &&
        std::abs(motion.theta()) <= limits.most_rad && std::abs(motion.theta()) >= limits.least_rad)
      found.emplace_back(before, now);
    before = now;
  }
  std::vector<Pair> pairs;
  const std::size_t every = 1 + found.size() / kPairs;
  for (std::size_t i = 0; i < found.size(); i += every) {
    const auto [before, now] = found[i];
    pairs.push_back({usable(log.scans[before], body), usable(log.scans[now], body),
                     odometry_between(log, before, now)});
  }
  return pairs;
}

/// Mean misfit [m] of the pairs, with odometry's translations scaled and rotated.
double mean_misfit_m(std::span<const Pair> pairs, const Se2& base_from_lidar, double factor,
                     double turn_rad) {
  const Eigen::Rotation2Dd turn{turn_rad};
  double sum_m = 0.0;
  for (const Pair& pair : pairs) {
    const Se2 motion{turn * (factor * pair.motion.translation()), pair.motion.theta()};
    sum_m += misfit_m(pair.before, pair.now, base_from_lidar.inverse() * motion * base_from_lidar)
                 .value_or(kNoOverlap_m);
  }
  return sum_m / static_cast<double>(pairs.size());
}

/// The rotation of least misfit: vertex of a parabola through the minimum and its neighbours 4
/// degrees away. nullopt if the misfit is flat, as where no two scans overlap.
std::optional<double> best_turn_rad(std::span<const Pair> pairs, const Se2& base_from_lidar) {
  constexpr double kStep_rad = radians(1.0);
  constexpr std::size_t kSteps = 34;  // on each side of 0
  constexpr std::size_t kAside = 4;
  constexpr double kFlat_m = 1e-6;
  std::array<double, 2 * kSteps + 1> misfits_m{};
  for (std::size_t i = 0; i < misfits_m.size(); ++i) {
    const double turn_rad = kStep_rad * (static_cast<double>(i) - static_cast<double>(kSteps));
    misfits_m[i] = mean_misfit_m(pairs, base_from_lidar, 1.0, turn_rad);
  }
  const auto least = std::min_element(misfits_m.begin() + kAside, misfits_m.end() - kAside);
  const double below_m = *(least - kAside);
  const double above_m = *(least + kAside);
  const double curvature_m = below_m - 2.0 * *least + above_m;
  if (curvature_m < kFlat_m) return std::nullopt;
  const double aside = 0.5 * (below_m - above_m) / curvature_m;
  return kStep_rad * (static_cast<double>(least - misfits_m.begin()) - static_cast<double>(kSteps) +
                      static_cast<double>(kAside) * aside);
}

Se2 mirrored(const Se2& pose) {
  return {pose.x(), -pose.y(), -pose.theta()};
}

}  // namespace

std::optional<double> odometry_factor(const ImportedLog& log, const BodyBeams& body) {
  constexpr MotionLimits kAnyDistance{1e-3, 1e9, 0.2};
  constexpr double kMin = 5e-4;  // the factor for millimetres is 0.001, for inches 0.0254
  constexpr double kMax = 50.0;
  constexpr double kStep = 1.1;
  constexpr double kFarFrom1 = 1.25;   // smaller errors are calibrated by the estimators
  constexpr double kMuchBetter = 0.7;  // largest ratio of misfits; 0.85 can be due to a wrong yaw
  const std::vector<Pair> pairs = pairs_of(log, body, kAnyDistance);
  if (pairs.size() < kMinPairs) return std::nullopt;
  const Se2 base_from_lidar = log.robot.lidar.base_from_lidar();
  const double as_it_is_m = mean_misfit_m(pairs, base_from_lidar, 1.0, 0.0);
  double best = 1.0;
  double least_m = as_it_is_m;
  for (double factor = kMin; factor < kMax; factor *= kStep) {
    const double misfit_m = mean_misfit_m(pairs, base_from_lidar, factor, 0.0);
    if (misfit_m >= least_m) continue;
    least_m = misfit_m;
    best = factor;
  }
  const bool is_near_1 = best < kFarFrom1 && best > 1.0 / kFarFrom1;
  return least_m > kMuchBetter * as_it_is_m || is_near_1 ? std::nullopt : std::optional{best};
}

std::optional<YawError> lidar_yaw_error(const ImportedLog& log, const BodyBeams& body) {
  constexpr MotionLimits kStraightOn{0.2, 1.5, 0.06};
  constexpr std::size_t kParts = 8;  // parts of the log, for the standard deviation
  const std::vector<Pair> pairs = pairs_of(log, body, kStraightOn);
  if (pairs.size() < kMinPairs) return std::nullopt;
  const Se2 base_from_lidar = log.robot.lidar.base_from_lidar();
  std::array<double, kParts> found_rad{};
  for (std::size_t part = 0; part < kParts; ++part) {
    const std::size_t begin = part * pairs.size() / kParts;
    const std::size_t end = (part + 1) * pairs.size() / kParts;
    const auto turn_rad =
        best_turn_rad(std::span{pairs}.subspan(begin, end - begin), base_from_lidar);
    if (!turn_rad) return std::nullopt;
    // To a LiDAR turned to the left, the robot seems to drive to the right.
    found_rad[part] = -*turn_rad;
  }
  const double mean_rad =
      std::accumulate(found_rad.begin(), found_rad.end(), 0.0) / static_cast<double>(kParts);
  double sum_rad2 = 0.0;
  for (const double yaw_rad : found_rad)
    sum_rad2 += (yaw_rad - mean_rad) * (yaw_rad - mean_rad);
  return YawError{mean_rad, std::sqrt(sum_rad2 / static_cast<double>(kParts * (kParts - 1)))};
}

bool turns_against_odometry(const ImportedLog& log, const BodyBeams& body) {
  constexpr MotionLimits kTurning{0.0, 1.0, 0.8, 0.1};
  constexpr double kMuchBetter = 0.5;
  std::vector<Pair> pairs = pairs_of(log, body, kTurning);
  if (pairs.size() < kMinPairs) return false;
  const Se2 base_from_lidar = log.robot.lidar.base_from_lidar();
  const double as_it_is_m = mean_misfit_m(pairs, base_from_lidar, 1.0, 0.0);
  // Mirroring the motion is equivalent to mirroring the scans.
  for (Pair& pair : pairs)
    pair.motion = mirrored(pair.motion);
  return mean_misfit_m(pairs, mirrored(base_from_lidar), 1.0, 0.0) < kMuchBetter * as_it_is_m;
}

}  // namespace waymark
