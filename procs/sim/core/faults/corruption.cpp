// SPDX-License-Identifier: BSD-3-Clause
#include "sim/core/faults/corruption.hpp"

#include <limits>
#include <numbers>

namespace waymark {
namespace {

constexpr double kGarbageReach_m = 1.0;

}  // namespace

void make_garbage(LidarScan& scan, const LidarConfig& lidar, Random& random) {
  for (double& range_m : scan.ranges_m)
    range_m = random.uniform(lidar.range_min_m, lidar.range_max_m);
}

void scale_ranges(LidarScan& scan, const LidarConfig& lidar, double share) {
  for (double& range_m : scan.ranges_m) {
    range_m *= 1.0 + share;
    if (range_m > lidar.range_max_m) range_m = std::numeric_limits<double>::infinity();
    if (range_m < lidar.range_min_m) range_m = std::numeric_limits<double>::quiet_NaN();
  }
}

void make_garbage(OdometrySample& sample, Random& random) {
  const Eigen::Vector2d off_m{random.uniform(-kGarbageReach_m, kGarbageReach_m),
                              random.uniform(-kGarbageReach_m, kGarbageReach_m)};
  sample.odom_from_base = {sample.odom_from_base.translation() + off_m,
                           random.uniform(-std::numbers::pi, std::numbers::pi)};
}

WheelPair SpinningWheels::counted(const WheelPair& angles, const Faults& odometry,
                                  const Moment& moment) {
  if (const FaultConfig* fault = odometry.active(FaultKind::kWrong, moment)) {
    if (fault->wheel != Wheel::kRight) spun_.left += fault->share * (angles.left - last_.left);
    if (fault->wheel != Wheel::kLeft) spun_.right += fault->share * (angles.right - last_.right);
  }
  last_ = angles;
  return {angles.left + spun_.left, angles.right + spun_.right};
}

}  // namespace waymark
