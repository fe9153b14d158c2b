// SPDX-License-Identifier: BSD-3-Clause
// Long simulated drives of the default estimator: accuracy over seeds, and bounds of what it keeps.
#include "estimator_run.hpp"
#include "slam/core/estimators/waymark.hpp"

#include <gtest/gtest.h>

#include <memory>
#include <vector>

namespace waymark {
namespace {

using test::corridor_with_markers;
using test::estimator_setup_of;
using test::run;
using test::run_waymark;
using test::SensorLog;
using test::setup_of;
using test::Step;
using test::SyntheticCorridor;

TEST(WaymarkDrives, MarkersBoundTheErrorAndItsCovarianceIsConsistent) {
  double nees = 0.0;
  int count = 0;
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    const SyntheticCorridor corridor = corridor_with_markers(seed);
    const std::vector<Step> steps = run_waymark(drive(corridor), corridor);
    EXPECT_LT(test::along_rmse_m(steps), 0.02) << "seed " << seed;
    for (std::size_t i = steps.size() / 4; i < steps.size(); ++i) {
      Eigen::Vector3d error{
          steps[i].estimate.map_from_base.x() - steps[i].truth.x(),
          steps[i].estimate.map_from_base.y() - steps[i].truth.y(),
          angle_difference(steps[i].estimate.map_from_base.theta(), steps[i].truth.theta())};
      nees += error.dot(steps[i].estimate.covariance.ldlt().solve(error));
      ++count;
    }
  }
  EXPECT_LT(nees / count, 8.0);  // 3 degrees of freedom; four drives are few
}

/// Ids of a detector that sees markers in noise, in a fixed map.
TEST(WaymarkDrives, AFloodOfIdsIsBounded) {
  constexpr std::size_t kMax = 4096;
  constexpr int kInAFrame = 2;
  constexpr double kStep_m = 5.0;  // landmarks leave the window soon
  EstimatorSetup setup;
  setup.map_mode = MapMode::kLocalise;
  setup.loaded_map = std::make_shared<MapSnapshot>();
  WaymarkEstimator estimator{setup, {}};
  int id = 0;
  for (int k = 0; id < 5000; ++k) {
    Observation observation;
    observation.time = timestamp_from_us(std::int64_t{1000000} * (k + 1));
    observation.elapsed_s = 1.0;
    if (k > 0) observation.motion = Motion::between({}, {kStep_m, 0.0, 0.0});
    for (int i = 0; i < kInAFrame; ++i) {
      MarkerSighting seen;
      seen.id = ++id;
      seen.time = observation.time;
      seen.base_from_marker = {1.5, 1.0 * i, 3.1};
      seen.covariance_in_base = 1e-4 * Eigen::Matrix3d::Identity();
      observation.sightings.push_back(seen);
    }
    estimator.update(observation);
  }
  EXPECT_EQ(estimator.landmarks().size(), kMax);
}

/// Up and down the same corridor: the graph grows with the area, and is as good as one that keeps
/// everything.
TEST(WaymarkDrives, RevisitingAPlaceDoesNotMakeTheGraphGrow) {
  SyntheticCorridor corridor = corridor_with_markers(5);
  corridor.speed_m_s = 1.0;
  corridor.length_m = 7.0;
  corridor.turn_back_every_m = 5.0;
  corridor.markers = test::opposite_markers(corridor, 2.0, 3.0);
  const auto graph_after = [&](int passes, int per_place, double& error_m) {
    corridor.drive_m = corridor.turn_back_every_m * passes;
    WaymarkConfig config;
    config.keyframes_per_place = per_place;
    WaymarkEstimator estimator{estimator_setup_of(corridor, 1), config};
    error_m = test::along_rmse_m(run(estimator, drive(corridor), setup_of(corridor)));
    return static_cast<double>(estimator.pose_graph()->poses.size());
  };
  constexpr int kFew = 10;
  constexpr int kAll = 100000;
  double error_m = 0.0;
  double error_of_all_m = 0.0;
  const double half = graph_after(16, kFew, error_m);
  const double whole = graph_after(32, kFew, error_m);
  const double all = graph_after(32, kAll, error_of_all_m);
  EXPECT_LT(whole, 1.1 * half);
  EXPECT_GT(all, 2.0 * whole);
  EXPECT_LT(error_m, 1.1 * error_of_all_m + 0.001);
}

/// The returning marker makes the solver step the whole graph; meanwhile the new one must not be in
/// the window without a measurement.
TEST(WaymarkDrives, AReturningMarkerAndANewOneInOneScanAreBothUsed) {
  SyntheticCorridor corridor = corridor_with_markers(3);
  corridor.speed_m_s = 1.0;
  corridor.length_m = 40.0;
  corridor.turn_back_every_m = 30.0;
  corridor.drive_m = 60.0;
  corridor.markers = test::opposite_markers(corridor, 4.0, 4.0);
  SensorLog log = drive(corridor);
  constexpr int kHungUpMeanwhile = 4;  // opposite of marker 5
  for (std::size_t i = 0; i < log.frames.size() / 2; ++i) {
    std::erase_if(log.frames[i].detections, [](const MarkerDetection& detection) {
      return detection.id == kHungUpMeanwhile;
    });
  }
  const std::vector<Step> steps = run_waymark(log, corridor);
  for (const Step& step : steps)
    ASSERT_TRUE(step.estimate.covariance.allFinite());
  EXPECT_LT(test::along_rmse_m(steps), 0.05);
  EXPECT_FALSE(steps.back().estimate.calibration_widened);
}

}  // namespace
}  // namespace waymark
