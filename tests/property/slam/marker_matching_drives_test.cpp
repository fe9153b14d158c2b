// SPDX-License-Identifier: BSD-3-Clause
// Simulated drives of marker matching over seeds, beside dead reckoning.
#include "estimator_run.hpp"
#include "slam/core/estimators/marker_matching.hpp"
#include "slam/core/estimators/odometry.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace waymark {
namespace {

using test::along_rmse_m;
using test::run;
using test::SensorLog;
using test::setup_of;
using test::short_corridor;
using test::Step;
using test::SyntheticCorridor;

std::vector<Step> match_markers(const SensorLog& log, const SensorSetup& setup,
                                std::uint64_t seed) {
  EstimatorSetup estimator_setup;
  estimator_setup.seed = seed;
  MarkerMatchingEstimator estimator{estimator_setup, {}};
  return run(estimator, log, setup);
}

// The paper's claim in small, with its controls: odometry, and the same filter without ids.
TEST(MarkerMatching, CutsTheErrorAlongTheCorridorOfOdometryAndOfBlankIdsBy40Percent) {
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    const SyntheticCorridor corridor = short_corridor(seed);
    const SensorLog log = test::drive(corridor);
    SensorSetup blank = setup_of(corridor);
    blank.blank_ids = true;
    OdometryEstimator odometry{EstimatorSetup{}};

    const double by_odometry_m = along_rmse_m(run(odometry, log, setup_of(corridor)));
    const auto matched = match_markers(log, setup_of(corridor), seed);
    const double blank_m = along_rmse_m(match_markers(log, blank, seed));

    EXPECT_LT(along_rmse_m(matched), 0.6 * by_odometry_m) << seed;
    EXPECT_LT(along_rmse_m(matched), 0.6 * blank_m) << seed;
    const Step& last = matched.back();
    EXPECT_NEAR(last.estimate.map_from_base.y(), last.truth.y(), 0.1) << seed;
    EXPECT_NEAR(last.estimate.map_from_base.theta(), last.truth.theta(), radians(2.0)) << seed;
  }
}

// Without markers nothing in a corridor shows how far the robot has driven, so its variance along
// the corridor must grow.
TEST(MarkerMatching, WithoutMarkersVarianceAlongTheCorridorGrowsWithoutBias) {
  double mean_pull_m = 0.0;
  constexpr int kSeeds = 6;
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    SyntheticCorridor corridor = short_corridor(seed);
    corridor.length_m = 40.0;
    corridor.start_x_m = 10.0;  // end walls out of sight
    corridor.scale_error = 0.0;
    corridor.along_noise_per_sqrt_m = 0.0;
    corridor.markers.clear();
    const auto steps = match_markers(test::drive(corridor), setup_of(corridor), seed);

    const auto variance_at = [&](double share) {
      const auto index = static_cast<std::size_t>(share * static_cast<double>(steps.size() - 1));
      return steps[index].estimate.covariance(0, 0);
    };
    // 0.01 m per sqrt(m): 1.2e-3 m^2 after 12 m. Resampling by the walls reduces it a little, as
    // in every finite filter.
    EXPECT_GT(variance_at(1.0), 0.3 * 1.2e-3) << seed;
    EXPECT_GT(variance_at(1.0), variance_at(0.3)) << seed;
    EXPECT_EQ(steps.back().estimate.health, Health::kDegenerate) << seed;
    EXPECT_EQ(steps.back().estimate.weak_axis_source, WeakAxisSource::kOdometry) << seed;
    mean_pull_m += (steps.back().estimate.map_from_base.x() - steps.back().truth.x()) / kSeeds;
  }
  // Mean of 6 random walks of 0.035 m after 12 m: 0.014 m. GMapping falls metres behind here.
  EXPECT_NEAR(mean_pull_m, 0.0, 0.05);
}

// Seen at the start, then hidden, then seen again. Hidden to the end it would leave 0.15 or more.
TEST(MarkerMatching, AKnownMarkerShrinksTheVariance) {
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    SyntheticCorridor corridor = short_corridor(seed);
    corridor.length_m = 40.0;
    corridor.start_x_m = 10.0;
    corridor.drive_m = 4.0;
    corridor.markers = {{0, {16.0, 1.0}, radians(-90.0)}, {1, {16.0, -1.0}, radians(90.0)}};
    SensorLog log = test::drive(corridor);
    const Timestamp start = log.truth.front().time;
    const Timestamp hidden = start + duration_from_seconds(1.0 / corridor.speed_m_s);
    const Timestamp again = start + duration_from_seconds(3.0 / corridor.speed_m_s);
    for (MarkerDetections& frame : log.frames)
      if (frame.time > hidden && frame.time < again) frame.detections.clear();

    const auto steps = match_markers(log, setup_of(corridor), seed);
    double widest_m2 = 0.0;
    for (const Step& step : steps)
      if (step.estimate.time < again)
        widest_m2 = std::max(widest_m2, step.estimate.covariance(0, 0));
    EXPECT_LT(steps.back().estimate.covariance(0, 0), 0.1 * widest_m2) << seed;
    EXPECT_EQ(steps.back().estimate.weak_axis_source, WeakAxisSource::kMarkers) << seed;
    EXPECT_EQ(steps.back().estimate.health, Health::kTracking) << seed;
  }
}

TEST(MarkerMatching, AMirroredWorldGivesAMirroredResult) {
  const SyntheticCorridor corridor = short_corridor(2);
  const SensorLog log = test::drive(corridor);
  const auto direct = match_markers(log, setup_of(corridor), 1);
  const auto mirrored = match_markers(test::mirrored(log), setup_of(corridor), 1);
  ASSERT_EQ(direct.size(), mirrored.size());
  const Se2& a = direct.back().estimate.map_from_base;
  const Se2& b = mirrored.back().estimate.map_from_base;
  // The particles' noise is not mirrored: equal up to the filter's own scatter.
  EXPECT_NEAR(a.x(), b.x(), 0.06);
  EXPECT_NEAR(a.y(), -b.y(), 0.1);
  EXPECT_NEAR(a.theta(), -b.theta(), radians(1.5));
}

TEST(MarkerMatching, EqualSeedsGiveEqualResultsToTheLastBit) {
  const SyntheticCorridor corridor = short_corridor(3);
  const SensorLog log = test::drive(corridor);
  const auto one = match_markers(log, setup_of(corridor), 7);
  const auto same = match_markers(log, setup_of(corridor), 7);
  const auto other = match_markers(log, setup_of(corridor), 8);
  EXPECT_EQ(one.back().estimate.map_from_base.x(), same.back().estimate.map_from_base.x());
  EXPECT_EQ(one.back().estimate.covariance, same.back().estimate.covariance);
  EXPECT_NE(one.back().estimate.map_from_base.x(), other.back().estimate.map_from_base.x());
}

TEST(MarkerMatching, MarkersAreMappedWhereTheyAre) {
  const SyntheticCorridor corridor = short_corridor(1);
  EstimatorSetup estimator_setup;
  MarkerMatchingEstimator estimator{estimator_setup, {}};
  run(estimator, test::drive(corridor), setup_of(corridor));
  const auto landmarks = estimator.landmarks();
  ASSERT_EQ(landmarks.size(), corridor.markers.size());
  for (std::size_t i = 0; i < landmarks.size(); ++i) {
    const test::SyntheticMarker& truth = corridor.markers[i];
    EXPECT_EQ(landmarks[i].id, truth.id);
    EXPECT_NEAR(landmarks[i].map_from_marker.x(), truth.position_m.x() - corridor.start_x_m, 0.15);
    EXPECT_NEAR(landmarks[i].map_from_marker.y(), truth.position_m.y(), 0.15);
    const CellIndex cell =
        estimator.map().frame.cell_of(landmarks[i].map_from_marker.translation());
    EXPECT_EQ(estimator.map().markers[cell].most_supported(), truth.id);
  }
}

TEST(Odometry, TheTraceOfItsCovarianceNeverShrinks) {
  const SyntheticCorridor corridor = short_corridor(1);
  const SensorLog log = test::drive(corridor);
  OdometryEstimator estimator{EstimatorSetup{}};
  double last_trace = 0.0;
  for (const Step& step : run(estimator, log, setup_of(corridor))) {
    const double trace = step.estimate.covariance.trace();
    EXPECT_GE(trace, last_trace);
    last_trace = trace;
  }
}

}  // namespace
}  // namespace waymark
