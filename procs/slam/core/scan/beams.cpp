// SPDX-License-Identifier: BSD-3-Clause
#include "slam/core/scan/beams.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace waymark {

Timestamp last_beam_time(const LidarScan& scan) {
  if (scan.beam_time_offsets.empty()) return scan.time;
  return scan.time + std::max(Duration{0}, *std::max_element(scan.beam_time_offsets.begin(),
                                                             scan.beam_time_offsets.end()));
}

Timestamp first_beam_time(const LidarScan& scan) {
  if (scan.beam_time_offsets.empty()) return scan.time;
  return scan.time + std::min(Duration{0}, *std::min_element(scan.beam_time_offsets.begin(),
                                                             scan.beam_time_offsets.end()));
}

LidarScan at_middle_of_sweep(LidarScan scan) {
  if (scan.beam_time_offsets.empty()) return scan;
  const auto [first, last] =
      std::minmax_element(scan.beam_time_offsets.begin(), scan.beam_time_offsets.end());
  const Duration middle = (*first + *last) / 2;
  scan.time += middle;
  for (Duration& offset : scan.beam_time_offsets)
    offset -= middle;
  return scan;
}

std::vector<Beam> beams_of(const LidarScan& scan, const LidarSetup& lidar,
                           const OdometryBuffer& odometry) {
  const bool is_rolling = !scan.beam_time_offsets.empty();
  const Se2 base_from_odom = is_rolling ? odometry.pose_at(scan.time).inverse() : Se2{};
  Se2 base_from_lidar = lidar.base_from_lidar;

  std::vector<Beam> beams;
  beams.reserve(scan.ranges_m.size());
  for (std::size_t i = 0; i < scan.ranges_m.size(); ++i) {
    const double range_m = scan.ranges_m[i];
    const double angle_rad = scan.angles_rad[i];
    if (!(range_m >= lidar.range_min_m && range_m <= lidar.range_max_m)) continue;
    if (is_rolling) {
      const Se2 odom_from_base = odometry.pose_at(scan.time + scan.beam_time_offsets[i]);
      base_from_lidar = base_from_odom * odom_from_base * lidar.base_from_lidar;
    }
    const Eigen::Vector2d end_in_lidar{range_m * std::cos(angle_rad),
                                       range_m * std::sin(angle_rad)};
    beams.push_back({static_cast<int>(i), base_from_lidar.translation(),
                     base_from_lidar * end_in_lidar, range_m});
  }
  return beams;
}

MeanSweep mean_sweep(const LidarScan& scan, const OdometryBuffer& odometry) {
  const Timestamp first = first_beam_time(scan);
  const Timestamp last = last_beam_time(scan);
  MeanSweep mean;
  if (first == last) return mean;
  for (const auto& [from, to] : {std::pair{first, scan.time}, std::pair{scan.time, last}}) {
    const Motion part = odometry.motion_between(from, to);
    const double share = to_seconds(to - from) / to_seconds(last - first);
    // The mean of a random walk has a third of the variance of its end.
    mean.distance_m += share * share * part.distance_m / 3.0;
    mean.turn_rad += share * share * part.turn_rad / 3.0;
  }
  return mean;
}

}  // namespace waymark
