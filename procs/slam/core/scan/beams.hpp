// SPDX-License-Identifier: BSD-3-Clause
// The beams of a scan that have a return, in the base frame.
#pragma once

#include "common/geometry/se2.hpp"
#include "common/sensors/sensors.hpp"
#include "slam/core/motion/odometry_buffer.hpp"

#include <Eigen/Core>

#include <vector>

namespace waymark {

/// Mounting and valid ranges of the LiDAR.
struct LidarSetup {
  Se2 base_from_lidar{};
  double range_min_m{0.12};
  double range_max_m{3.5};
};

/// One beam with a return, in the base frame at the scan's time.
struct Beam {
  int index{0};  ///< in the LidarScan
  Eigen::Vector2d start_in_base{Eigen::Vector2d::Zero()};
  Eigen::Vector2d end_in_base{Eigen::Vector2d::Zero()};
  double range_m{0.0};
};

/// Equivalent motion of a sweep: its random-walk covariance equals that of the beams' mean position
/// error relative to the scan's pose. Zero if all beams were measured at once.
struct MeanSweep {
  double distance_m{0.0};
  double turn_rad{0.0};  ///< absolute
};

/// The same scan, stamped with the middle of its sweep: relative to the pose at that time, the
/// beams have the least odometry noise. Without times per beam the scan is unchanged.
LidarScan at_middle_of_sweep(LidarScan scan);

/// Latest (earliest) time of a beam, or the scan's own time if that is later (earlier).
Timestamp last_beam_time(const LidarScan& scan);
Timestamp first_beam_time(const LidarScan& scan);

/// Beams with a range in [range_min_m, range_max_m]; others (no return, invalid) are left out. If
/// the scan has a time per beam, the motion during the sweep is compensated with odometry, which
/// must cover the sweep and the scan's time.
std::vector<Beam> beams_of(const LidarScan& scan, const LidarSetup& lidar,
                           const OdometryBuffer& odometry);

/// @param odometry  as for beams_of().
MeanSweep mean_sweep(const LidarScan& scan, const OdometryBuffer& odometry);

}  // namespace waymark
