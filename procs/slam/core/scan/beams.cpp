// SPDX-License-Identifier: BSD-3-Clause
#include "slam/core/scan/beams.hpp"

#include <algorithm>
#include <cmath>

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

}  // namespace waymark
