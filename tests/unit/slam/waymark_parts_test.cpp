// SPDX-License-Identifier: BSD-3-Clause
// The parts of the waymark estimator, each against something slow and obvious.
#include "common/random/random.hpp"
#include "slam/core/calibration/odometry_calibration.hpp"
#include "slam/core/landmark/marker_landmarks.hpp"
#include "slam/core/matching/surface_matching.hpp"
#include "slam/core/proposal/pose_proposal.hpp"

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <utility>

namespace waymark {
namespace {

Eigen::Matrix3d diagonal(double x, double y, double yaw) {
  return Eigen::Vector3d{x * x, y * y, yaw * yaw}.asDiagonal();
}

MarkerMeasurement measurement_at(const Se2& base_from_marker, int id = 7) {
  return {id, {}, base_from_marker, diagonal(0.01, 0.005, 0.02), true};
}

TEST(MarkerMeasurementModel, DerivativesAgreeWithDifferences) {
  constexpr double kStep = 1e-6;
  Random random{1};
  for (int round = 0; round < 50; ++round) {
    const Se2 pose{random.normal(), random.normal(), random.uniform(-3.0, 3.0)};
    const Se2 marker{random.normal(), random.normal(), random.uniform(-3.0, 3.0)};
    const MarkerMeasurement measured = measurement_at(pose.inverse() * marker);
    const Eigen::Matrix3d none = Eigen::Matrix3d::Zero();
    const Innovation at = compare(measured, marker, none, pose);
    for (int axis = 0; axis < 3; ++axis) {
      const Eigen::Vector3d step = kStep * Eigen::Vector3d::Unit(axis);
      const Eigen::Vector3d by_pose =
          -compare(measured, marker, none, deviated(pose, step)).residual / kStep;
      const Eigen::Vector3d by_marker =
          -compare(measured, deviated(marker, step), none, pose).residual / kStep;
      EXPECT_LT((by_pose - at.by_pose.col(axis)).norm(), 1e-4);
      EXPECT_LT((by_marker - at.by_landmark.col(axis)).norm(), 1e-4);
    }
  }
}

// One dimension is enough to integrate by hand: only x is uncertain.
TEST(PoseProposal, AgreesWithBruteForceIntegration) {
  const Se2 prior{1.0, 2.0, 0.1};
  const Eigen::Matrix3d prior_covariance = diagonal(0.05, 1e-4, 1e-4);
  constexpr double kMeasured = 1.08;
  constexpr double kVariance = 0.03 * 0.03;
  const PoseProposal proposal = propose(prior, prior_covariance, [&](const Se2& pose) {
    PoseInformation information;
    const double residual = pose.x() - kMeasured;
    information.information(0, 0) = 1.0 / kVariance;
    information.gradient.x() = residual / kVariance;
    information.cost = 0.5 * residual * residual / kVariance;
    return information;
  });
  double mass = 0.0;
  double mean = 0.0;
  double square = 0.0;
  constexpr double kStep = 1e-4;
  for (double x = 0.5; x < 1.5; x += kStep) {
    const double density = std::exp(-0.5 * std::pow((x - prior.x()) / 0.05, 2)) /
                           (0.05 * std::sqrt(2.0 * std::numbers::pi)) *
                           std::exp(-0.5 * std::pow(x - kMeasured, 2) / kVariance);
    mass += kStep * density;
    mean += kStep * density * x;
    square += kStep * density * x * x;
  }
  mean /= mass;
  EXPECT_NEAR(proposal.mean.x(), mean, 1e-6);
  EXPECT_NEAR(proposal.covariance(0, 0), square / mass - mean * mean, 1e-8);
  EXPECT_NEAR(proposal.log_evidence, std::log(mass), 1e-6);
  EXPECT_NEAR(proposal.mean.y(), prior.y(), 1e-9);
}

TEST(OdometryCalibration, IsTheRegressionOverAllSteps) {
  OdometryNoise noise;
  OdometryCalibration calibration{noise};
  Random random{3};
  double information = 1.0 / (noise.scale_sigma * noise.scale_sigma);
  double weighted = 0.0;
  for (int i = 0; i < 100; ++i) {
    const double measured_m = random.uniform(0.05, 0.15);
    const double true_m = 0.99 * measured_m + random.normal(0.0, 0.001);
    const Motion motion{Se2{measured_m, 0.0, 0.0}, measured_m, 0.0};
    calibration.learn(motion, Se2{true_m, 0.0, 0.0}, noise);
    const double variance = noise.along_per_sqrt_m * noise.along_per_sqrt_m * measured_m + 1e-9;
    information += measured_m * measured_m / variance;
    weighted += measured_m * (true_m - measured_m) / variance;
  }
  EXPECT_NEAR(calibration.scale(), weighted / information, 1e-12);
  EXPECT_NEAR(calibration.scale_variance(), 1.0 / information, 1e-15);
  EXPECT_NEAR(calibration.scale(), -0.01, 0.003);
}

TEST(OdometryCalibration, CorrectsWhatItLearnt) {
  OdometryNoise noise;
  OdometryCalibration calibration{noise};
  const Motion motion{Se2{0.1, 0.0, 0.0}, 0.1, 0.0};
  for (int i = 0; i < 2000; ++i)
    calibration.learn(motion, Se2{0.101, 0.0, 0.0002}, noise);
  EXPECT_NEAR(calibration.corrected(motion).x(), 0.101, 1e-4);
  EXPECT_NEAR(calibration.corrected(motion).theta(), 0.0002, 1e-5);
}

TEST(MarkerLandmarks, CopiesShareUntilOneChanges) {
  MarkerLandmarks one;
  one.add(measurement_at({1.0, 1.0, -1.5}, 3), {});
  one.add(measurement_at({2.0, 1.0, -1.5}, 4), {});
  MarkerLandmarks other = one;
  EXPECT_EQ(&one[0], &other[0]);
  const Landmark before = one[0];
  other.update(0, measurement_at({1.01, 1.0, -1.5}, 3), {});
  EXPECT_NE(&one[0], &other[0]);
  EXPECT_EQ(&one[1], &other[1]);
  EXPECT_EQ(one[0].map_from_marker.x(), before.map_from_marker.x());
  EXPECT_EQ(one[0].sightings, 1);
  EXPECT_NEAR(other[0].map_from_marker.x(), 1.005, 1e-6);
  EXPECT_EQ(other[0].sightings, 2);
}

TEST(MarkerLandmarks, AnIdIsAClass) {
  MarkerLandmarks markers;
  markers.add(measurement_at({1.0, 1.0, -1.5}, 3), {});
  markers.add(measurement_at({5.0, 1.0, -1.5}, 3), {});
  EXPECT_EQ(markers[1].instance, 1);
  const auto nearest =
      markers.nearest(measurement_at({4.98, 1.0, -1.5}, 3), {}, diagonal(0.05, 0.05, 0.05));
  ASSERT_TRUE(nearest);
  EXPECT_EQ(nearest->innovation.landmark, 1U);
  EXPECT_FALSE(markers.nearest(measurement_at({1.0, 1.0, -1.5}, 9), {}, diagonal(1, 1, 1)));
}

/// A robot in the middle of a corridor of 2 m, walls in sight on both sides.
std::vector<AnnotatedBeam> corridor_beams(double noise_m, Random& random) {
  std::vector<AnnotatedBeam> beams;
  for (int i = 0; i < 360; ++i) {
    const double angle_rad = radians(i);
    const double range_m = 1.0 / std::abs(std::sin(angle_rad)) + random.normal(0.0, noise_m);
    if (!(range_m < 3.5)) continue;
    const Eigen::Vector2d end = range_m * Eigen::Vector2d{std::cos(angle_rad), std::sin(angle_rad)};
    beams.push_back({Beam{i, Eigen::Vector2d::Zero(), end, range_m}});
  }
  return beams;
}

TEST(SurfaceMatching, FindsThePoseAcrossABareCorridorAndNothingAlongIt) {
  Random random{5};
  SurfaceMap map{GridFrame::centred_on_map_origin(0.05)};
  for (int scan = 0; scan < 20; ++scan) {
    for (const AnnotatedBeam& beam : corridor_beams(0.01, random))
      map.add(beam.beam.end_in_base);
  }
  const auto beams = corridor_beams(0.01, random);
  const Se2 start{0.3, 0.03, 0.02};
  const PoseProposal matched = propose(start, diagonal(1.0, 1.0, 1.0), [&](const Se2& pose) {
    return match_surfaces(beams, map, pose, {}).pose;
  });
  EXPECT_NEAR(matched.mean.y(), 0.0, 0.003);
  EXPECT_NEAR(matched.mean.theta(), 0.0, 0.003);
  EXPECT_NEAR(matched.mean.x(), 0.3, 0.002);  // nothing pulls
  EXPECT_NEAR(matched.covariance(0, 0), 1.0, 0.05);
}

TEST(WallFit, ExtendsTheWallWithItsUncertainty) {
  Random random{6};
  const auto beams = corridor_beams(0.01, random);
  const auto near = fit_wall(beams, {1.0, 1.02}, radians(-88.0), 0.01, 1.5);
  const auto far = fit_wall(beams, {3.8, 1.02}, radians(-88.0), 0.01, 1.5);
  ASSERT_TRUE(near && far);
  EXPECT_NEAR(near->point.y(), 1.0, 4.0 * near->sigma_m);
  EXPECT_NEAR(far->point.y(), 1.0, 4.0 * far->sigma_m);
  EXPECT_GT(far->sigma_m, 1.5 * near->sigma_m);
  EXPECT_FALSE(fit_wall(beams, {0.0, 0.2}, radians(-90.0), 0.01, 1.5));
}

TEST(MeasureMarkers, AFlippedViewGivesNoMeasurement) {
  Random random{8};
  Observation observation;
  observation.beams = corridor_beams(0.01, random);
  MarkerSighting sighting;
  sighting.id = 2;
  sighting.base_from_marker = {2.5, 1.01, radians(-88.0)};
  sighting.covariance_in_base = diagonal(0.02, 0.01, 0.03);
  sighting.size_m = 0.4;
  observation.sightings = {sighting};
  const auto upright = measure_markers(observation, 0.01, {0.07, 0.0, 0.0}, {});
  ASSERT_EQ(upright.size(), 1U);
  EXPECT_TRUE(upright[0].is_on_wall);
  EXPECT_NEAR(upright[0].base_from_marker.y(), 1.0, 0.006);
  EXPECT_LT(upright[0].covariance(0, 0), 2.0 * sighting.covariance_in_base(0, 0));
  observation.sightings[0].base_from_marker = {2.5, 1.01, radians(-130.0)};
  const auto flipped = measure_markers(observation, 0.01, {0.07, 0.0, 0.0}, {});
  EXPECT_TRUE(flipped.empty());
}

}  // namespace
}  // namespace waymark
