// SPDX-License-Identifier: BSD-3-Clause
#include "doctor/motion/lidar_motion.hpp"

#include "slam/core/registration/scan_match.hpp"
#include "slam/core/scan/beams.hpp"

#include <cmath>
#include <optional>

namespace waymark {
namespace {

constexpr std::size_t kMaxPoints = 360;
constexpr std::size_t kScansPerProgress = 50;
constexpr double kMaxDistance_m = 0.3;  // from the reference scan; then it is replaced
constexpr double kMaxTurned_rad = 0.35;
constexpr double kGuessSigma_m = 0.1;  // sigma of the predicted pose: the last step repeated
constexpr double kGuessSigma_rad = 0.1;
// A scan fits if so many of its beams end where the reference scan has walls, ...
constexpr double kMinMappedShare = 0.4;
constexpr double kMinInlierShare = 0.5;  // ... and so many of these lie on the walls

Points points_of(const LidarScan& scan, double range_max_m) {
  Points points;
  for (std::size_t i = 0; i < scan.ranges_m.size(); ++i) {
    const double range_m = scan.ranges_m[i];
    if (!(range_m > 0.0 && range_m < range_max_m)) continue;
    points.emplace_back(range_m * std::cos(scan.angles_rad[i]),
                        range_m * std::sin(scan.angles_rad[i]));
  }
  return points;
}

/// The scan that later ones are registered with.
struct Anchor {
  Timestamp time{};
  NdtMap map;
};

Anchor anchor_of(Timestamp time, const Points& points, const ScanMatchConfig& config) {
  Anchor anchor{time, NdtMap{config.cell_spacing_m}};
  for (const Eigen::Vector2d& point : points)
    anchor.map.add(point, kNoKeyframe);
  return anchor;
}

}  // namespace

LidarMotions lidar_motions(const ImportedLog& log, const ShowProgress& progress) {
  const ScanMatchConfig config{};
  const RangeNoise noise{log.robot.lidar.range_sigma_m};
  const Eigen::Matrix3d guess_covariance =
      Eigen::Vector3d{kGuessSigma_m, kGuessSigma_m, kGuessSigma_rad}.cwiseAbs2().asDiagonal();
  LidarMotions found;
  std::optional<Anchor> anchor;
  Se2 anchor_from_last{};
  Se2 last_step{};
  Timestamp last{};
  std::size_t done = 0;
  for (const ImportedScan& imported : log.scans) {
    if (progress && done % kScansPerProgress == 0)
      progress(static_cast<double>(done) / static_cast<double>(log.scans.size()));
    ++done;
    const LidarScan scan = at_middle_of_sweep(scan_of(imported));
    const Points points = thinned(points_of(scan, log.robot.lidar.range_max_m), kMaxPoints);
    if (!anchor) {
      anchor = anchor_of(scan.time, points, config);
      last = scan.time;
      continue;
    }
    const ScanMatch match = match_scan(points, anchor->map, anchor_from_last * last_step,
                                       guess_covariance, noise, config);
    const bool fits = match.is_usable(config) && match.mapped_share > kMinMappedShare &&
                      match.inlier_share > kMinInlierShare;
    if (!fits) {
      ++found.num_lost;
      anchor = anchor_of(scan.time, points, config);
      anchor_from_last = last_step = {};
      last = scan.time;
      continue;
    }
    last_step = anchor_from_last.inverse() * match.map_from_base;
    anchor_from_last = match.map_from_base;
    found.turns.push_back({last, scan.time, wrap_angle(last_step.theta())});
    last = scan.time;
    const bool is_far = anchor_from_last.translation().norm() > kMaxDistance_m ||
                        std::abs(wrap_angle(anchor_from_last.theta())) > kMaxTurned_rad;
    if (!is_far) continue;
    found.motions.push_back(
        {anchor->time, scan.time, anchor_from_last, !match.observed.is_degenerate});
    anchor = anchor_of(scan.time, points, config);
    anchor_from_last = {};
  }
  return found;
}

}  // namespace waymark
