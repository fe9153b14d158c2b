// SPDX-License-Identifier: BSD-3-Clause
// What a sighting of a marker measures, with the walls that the LiDAR sees.
#include "slam/core/landmark/marker_measurement.hpp"

#include "support/small_world.hpp"

#include <gtest/gtest.h>

namespace waymark {
namespace {

using test::corridor_beams;
using test::diagonal;

TEST(WallFit, ExtendsTheWallWithItsUncertainty) {
  Random random{6};
  const auto beams = corridor_beams(0.01, random);
  const auto near = fit_wall(beams, {1.0, 1.02}, radians(-88.0), 0.01, 1.5);
  const auto far = fit_wall(beams, {2.9, 1.02}, radians(-88.0), 0.01, 1.5);
  ASSERT_TRUE(near && far);
  EXPECT_NEAR(near->point.y(), 1.0, 4.0 * near->sigma_m);
  EXPECT_NEAR(far->point.y(), 1.0, 4.0 * far->sigma_m);
  EXPECT_GT(far->sigma_m, 1.5 * near->sigma_m);
  EXPECT_FALSE(fit_wall(beams, {0.0, 0.2}, radians(-90.0), 0.01, 1.5));
}

TEST(MeasureMarkers, OdometryBetweenFrameAndScanMovesASighting) {
  Observation observation;  // without walls: what the camera says
  MarkerSighting sighting;
  sighting.base_from_marker = {2.0, 1.0, radians(-90.0)};
  sighting.covariance_in_base = 1e-6 * Eigen::Matrix3d::Identity();
  observation.sightings = {sighting};
  const OdometryNoise odometry;
  const auto covariance_of = [&] {
    return measure_markers(observation, {}, odometry, {}).at(0).covariance;
  };
  const Eigen::Matrix3d at_once = covariance_of();
  observation.sightings[0].driven_since_frame_m = 0.05;
  observation.sightings[0].turned_since_frame_rad = 0.02;
  const Eigen::Matrix3d more = covariance_of() - at_once;

  const Eigen::Matrix3d walk = random_walk(0.05, 0.02, odometry);
  const auto seen_after = [&](const Eigen::Vector3d& error) {
    return moved_by(Se2{}, error).inverse() * sighting.base_from_marker;
  };
  constexpr double kStep = 1e-6;
  Eigen::Matrix3d by_motion;
  for (int axis = 0; axis < 3; ++axis) {
    const Eigen::Vector3d step = kStep * Eigen::Vector3d::Unit(axis);
    by_motion.col(axis) = pose_difference(seen_after(step), seen_after(-step)) / (2.0 * kStep);
  }
  EXPECT_TRUE(more.isApprox(by_motion * walk * by_motion.transpose(), 1e-6)) << more;
  EXPECT_GT(more(2, 2), 0.0);
}

TEST(MeasureMarkers, AWallFromARollingScanIsLessCertainThanFromAStillOne) {
  Random random{8};
  Observation observation;
  observation.beams = corridor_beams(0.01, random);
  MarkerSighting sighting;
  sighting.base_from_marker = {2.5, 1.0, radians(-90.0)};
  sighting.covariance_in_base = diagonal(0.02, 0.01, 0.03);
  observation.sightings = {sighting};
  const auto wall_covariance = [&] {
    return measure_markers(observation, {}, {}, {}).at(0).wall->covariance;
  };
  const Eigen::Matrix2d at_once = wall_covariance();
  observation.mean_sweep = {0.005, 0.01};
  const Eigen::Matrix2d more = wall_covariance() - at_once;
  const double turn_rad2 = turn_variance({}, 0.005, 0.01);
  EXPECT_GT(more(1, 1), turn_rad2);
  EXPECT_NEAR(more(0, 0) / more(1, 1), 2.5 * 2.5, 0.5) << "a turn moves what is ahead sideways";
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
  MarkerSensors sensors;
  sensors.base_from_camera = {0.07, 0.0, 0.0};
  const auto upright = measure_markers(observation, sensors, {}, {});
  ASSERT_EQ(upright.size(), 1U);
  EXPECT_TRUE(upright[0].wall.has_value());
  EXPECT_NEAR(upright[0].base_from_marker.y(), 1.0, 0.006);
  EXPECT_LT(upright[0].covariance(0, 0), 2.0 * sighting.covariance_in_base(0, 0));
  observation.sightings[0].base_from_marker = {2.5, 1.01, radians(-130.0)};
  const auto flipped = measure_markers(observation, sensors, {}, {});
  EXPECT_TRUE(flipped.empty());
}

// The camera's yaw error could not be learnt if its views were rejected.
TEST(MeasureMarkers, ACameraYawErrorBeyondItsConfiguredSigmaIsNotTakenForAFlip) {
  Random random{9};
  Observation observation;
  observation.beams = corridor_beams(0.01, random);
  MarkerSensors sensors;
  sensors.base_from_camera = {0.07, 0.0, 0.0};
  sensors.sigmas = {.calibration = {0.0005, 0.0001, 0.003},
                    .bearing_rad = 0.00003,
                    .position_m = 0.0001,
                    .bulge_m = 0.0005,
                    .skew_rad = 0.001};
  MarkerSighting sighting;
  sighting.id = 2;
  sighting.covariance_in_base = diagonal(0.02, 0.01, 0.001);
  sighting.size_m = 0.4;
  const Se2 turned{0.0, 0.0, radians(-0.5)};
  sighting.base_from_marker = turned * Se2{2.5, 1.0, radians(-90.0)};
  observation.sightings = {sighting};
  EXPECT_EQ(measure_markers(observation, sensors, {}, {}).size(), 1U);
}

}  // namespace
}  // namespace waymark
