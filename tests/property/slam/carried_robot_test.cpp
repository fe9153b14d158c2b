// SPDX-License-Identifier: BSD-3-Clause
// A robot that is lifted and put down elsewhere, where no marker is in view.
#include "common/geometry/chi2.hpp"
#include "estimator_run.hpp"
#include "slam/core/estimators/waymark.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <numbers>
#include <utility>

namespace waymark {
namespace {

using std::chrono::milliseconds;
using test::SensorLog;
using test::Step;
using test::SyntheticCorridor;

constexpr milliseconds kOdometryPeriod{33};
constexpr milliseconds kScanPeriod{200};
constexpr milliseconds kStand{3000};  // half of it before the lift

/// A corridor with markers at 4, 8 and 18 m on both sides.
SyntheticCorridor corridor_of(double start_x_m, double drive_m) {
  SyntheticCorridor corridor;
  corridor.length_m = 30.0;
  corridor.speed_m_s = 0.25;
  corridor.start_x_m = start_x_m;
  corridor.drive_m = drive_m;
  corridor.markers = test::opposite_markers(corridor, 4.0, 4.0);
  std::erase_if(corridor.markers,
                [](const test::SyntheticMarker& marker) { return marker.position_m.x() > 9.0; });
  for (const double side : {1.0, -1.0})
    corridor.markers.push_back({side > 0.0 ? 20 : 21,
                                {18.0, side},
                                side > 0.0 ? -0.5 * std::numbers::pi : 0.5 * std::numbers::pi});
  return corridor;
}

/// Appends a drive that begins elsewhere, after the robot has stood for a while. Its wheels do not
/// turn meanwhile.
void append_after_lift(SensorLog& log, SensorLog next, const SyntheticCorridor& corridor) {
  const Timestamp stands = log.odometry.back().time;
  const Se2 odom_from_stand = log.odometry.back().odom_from_base;
  const Se2 before = log.truth.back().world_from_base;
  const Se2 after = next.truth.front().world_from_base;
  for (milliseconds t = kOdometryPeriod; t < kStand; t += kOdometryPeriod) {
    log.odometry.push_back({stands + t, odom_from_stand});
    log.truth.push_back({stands + t, t < kStand / 2 ? before : after});
  }
  for (milliseconds t = kScanPeriod; t < kStand; t += kScanPeriod)
    log.scans.push_back(scan_from(corridor, t < kStand / 2 ? before : after, stands + t));
  const Duration later = stands + kStand - next.odometry.front().time;
  for (OdometrySample& sample : next.odometry)
    log.odometry.push_back({sample.time + later, odom_from_stand * sample.odom_from_base});
  for (const test::TruePose& pose : next.truth)
    log.truth.push_back({pose.time + later, pose.world_from_base});
  for (LidarScan& scan : next.scans) {
    scan.time += later;
    log.scans.push_back(std::move(scan));
  }
  for (MarkerDetections& frame : next.frames) {
    frame.time += later;
    log.frames.push_back(std::move(frame));
  }
}

TEST(CarriedRobot, IsLostUntilMarkersMappedBeforeShowWhereItHasDriven) {
  const SyntheticCorridor before = corridor_of(1.0, 9.0);
  SyntheticCorridor after = corridor_of(10.5, 22.0);
  after.initial_heading_rad = 2.2;
  after.turn_back_every_m = 11.0;
  after.seed = 2;
  SensorLog log = test::drive(before);
  const Timestamp lifted = log.odometry.back().time + kStand / 2;
  append_after_lift(log, test::drive(after), after);

  WaymarkEstimator estimator{test::estimator_setup_of(before, 1), {}};
  const std::vector<Step> steps = test::run(estimator, log, test::setup_of(before));
  const Step* found = nullptr;
  for (const Step& step : steps) {
    const Eigen::Vector3d error = pose_difference(step.estimate.map_from_base, step.truth);
    const bool is_right = error.head<2>().norm() < 0.1;
    if (step.estimate.time < lifted + std::chrono::seconds{2}) continue;
    if (!is_right) {
      EXPECT_EQ(step.estimate.health, Health::kLost);
      EXPECT_LT(chi2(error, step.estimate.covariance), kChi2Gate3);
      EXPECT_EQ(found, nullptr) << "lost again";
    } else if (found == nullptr && step.estimate.health != Health::kLost) {
      found = &step;
    }
  }
  ASSERT_NE(found, nullptr);
  EXPECT_EQ(estimator.statistics()->relocalisations, 1);

  // The path since the lift, and the markers seen on it, are where they belong.
  EXPECT_EQ(estimator.landmarks().size(), 6U);
  const std::vector<TimedPose> path = estimator.trajectory();
  ASSERT_EQ(path.size(), steps.size());
  for (std::size_t i = 0; i < path.size(); ++i) {
    if (path[i].time > lifted - kStand && path[i].time < lifted + kStand) continue;
    EXPECT_LT((path[i].map_from_base.translation() - steps[i].truth.translation()).norm(), 0.1);
  }
}

}  // namespace
}  // namespace waymark
