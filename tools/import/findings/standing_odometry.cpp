// SPDX-License-Identifier: BSD-3-Clause
#include "import/findings/standing_odometry.hpp"

#include "common/geometry/median.hpp"

#include <algorithm>
#include <cmath>

namespace waymark {
namespace {

constexpr std::size_t kScans = 100;  // largest number of scans that are compared
constexpr double kSameSigmas = 5.0;

bool stands(const std::vector<ImportedPose>& poses) {
  return std::ranges::all_of(poses, [&](const ImportedPose& sample) {
    return sample.pose.translation() == poses.front().pose.translation() &&
           sample.pose.theta() == poses.front().pose.theta();
  });
}

/// Median absolute difference [m] of beams with a range in both; 0 without any. Not affected by
/// people who walk by.
double difference_m(const LidarScan& a, const LidarScan& b) {
  std::vector<double> differences_m;
  for (std::size_t i = 0; i < std::min(a.ranges_m.size(), b.ranges_m.size()); ++i) {
    const double difference_m = std::abs(a.ranges_m[i] - b.ranges_m[i]);
    if (std::isfinite(difference_m)) differences_m.push_back(difference_m);
  }
  return differences_m.empty() ? 0.0 : upper_median(std::move(differences_m));
}

}  // namespace

std::optional<double> change_of_scans_while_standing_m(const ImportedLog& log) {
  if (!stands(log.odometry)) return std::nullopt;
  const LidarScan first = scan_of(log.scans.front());
  double most_m = 0.0;
  const std::size_t every = 1 + log.scans.size() / kScans;
  for (std::size_t i = 0; i < log.scans.size(); i += every)
    most_m = std::max(most_m, difference_m(first, scan_of(log.scans[i])));
  const double same_m = kSameSigmas * log.robot.lidar.range_sigma_m;
  return most_m > same_m ? std::optional{most_m} : std::nullopt;
}

}  // namespace waymark
