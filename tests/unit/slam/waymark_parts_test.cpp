// SPDX-License-Identifier: BSD-3-Clause
// The parts of the waymark estimator, each against something slow and obvious.
#include "common/random/random.hpp"
#include "slam/core/belief/belief.hpp"
#include "slam/core/matching/surface_matching.hpp"
#include "slam/core/proposal/pose_proposal.hpp"

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include <array>
#include <chrono>
#include <cmath>
#include <utility>
#include <vector>

namespace waymark {
namespace {

Eigen::Matrix3d diagonal(double x, double y, double yaw) {
  return Eigen::Vector3d{x * x, y * y, yaw * yaw}.asDiagonal();
}

MarkerMeasurement measurement_at(const Se2& base_from_marker, int id = 7) {
  MarkerMeasurement measurement;
  measurement.id = id;
  measurement.base_from_marker = base_from_marker;
  measurement.covariance = diagonal(0.01, 0.005, 0.02);
  return measurement;
}

Belief belief_with(const std::vector<MarkerMeasurement>& measurements) {
  Belief belief{{OdometryNoise{}, 0.005, 0.002}};
  for (const MarkerMeasurement& measurement : measurements)
    belief.add(measurement);
  return belief;
}

constexpr double kGate = 16.3;  // chi^2, 3 degrees of freedom: 99.9 %
const Motion kForward{Se2{0.5, 0.0, 0.02}, 0.5, 0.02};

TEST(OdometryErrors, DerivativesAgreeWithDifferences) {
  constexpr double kStep = 1e-6;
  const Motion motion{Se2{0.3, 0.05, 0.8}, 0.31, 0.8};
  const OdometryErrors errors{0.01, 0.02, -0.03, 0.04};
  const CorrectedMotion at = corrected_motion(motion, errors, {});
  for (int axis = 0; axis < errors.size(); ++axis) {
    const CorrectedMotion moved =
        corrected_motion(motion, errors + kStep * OdometryErrors::Unit(axis), {});
    const Eigen::Vector3d difference = deviation(at.start_from_end, moved.start_from_end) / kStep;
    EXPECT_LT((difference - at.by_errors.col(axis)).norm(), 1e-5) << axis;
  }
}

// A LiDAR ahead of the wheels' axle goes round it: left and back.
TEST(OdometryErrors, ALidarAheadOfTheWheelsSwingsWhenTheyTurnOnTheSpot) {
  const double quarter_rad = radians(90.0);
  const Motion left{Se2{0.0, 0.0, quarter_rad}, 0.0, quarter_rad};
  const Se2 moved = corrected_motion(left, {0.0, 0.0, 0.0, 0.2}, {}).start_from_end;
  EXPECT_NEAR(moved.x(), -0.2, 2e-3);
  EXPECT_NEAR(moved.y(), 0.2, 2e-3);
}

TEST(OdometryErrors, ATurnWithinItsNoiseTellsNothingOfTheScaleOfTurns) {
  const Motion straight{Se2{0.1, 0.0, 0.003}, 0.1, 0.003};
  EXPECT_TRUE(corrected_motion(straight, OdometryErrors::Zero(), {}).by_errors.col(2).isZero());
}

TEST(Belief, IsUnsureAlongTheWayAndAMarkerMakesItSurer) {
  Belief belief = belief_with({measurement_at({2.0, 1.0, -1.57})});
  belief.move(kForward, {});
  const Eigen::Matrix3d before = belief.pose_covariance();
  EXPECT_GT(before(0, 0), 0.0);
  const Se2 base_from_marker = belief.map_from_base().inverse() * Se2{2.0, 1.0, -1.57};
  const auto nearest = belief.nearest(measurement_at(base_from_marker));
  ASSERT_TRUE(nearest);
  EXPECT_NEAR(nearest->distance, 0.0, 1e-9);
  belief.correct(nearest->marker, measurement_at(base_from_marker), kGate);
  EXPECT_LT(belief.pose_covariance()(0, 0), before(0, 0));
  EXPECT_EQ(belief.markers()[0].sightings, 2);
}

TEST(Belief, LearnsTheScaleOfTheOdometryFromAMarker) {
  Belief belief = belief_with({measurement_at({3.0, 1.0, -1.57})});
  double true_x = 0.0;
  for (int i = 0; i < 40; ++i) {
    belief.move({Se2{0.05, 0.0, 0.0}, 0.05, 0.0}, {});
    true_x += 0.05 * 1.01;
    belief.correct(0, measurement_at({3.0 - true_x, 1.0, -1.57}), kGate);
  }
  const double sigma = std::sqrt(belief.odometry_errors_covariance()(0, 0));
  EXPECT_NEAR(belief.odometry_errors()[0], 0.01, 3.0 * sigma);
  EXPECT_LT(sigma, 0.01);
  EXPECT_NEAR(belief.map_from_base().x(), true_x, 0.02);
}

TEST(Belief, DrawingAnAxisMakesItExactAndLeavesTheOthers) {
  Belief belief = belief_with({measurement_at({2.0, 1.0, -1.57})});
  belief.move(kForward, {});
  const Eigen::Matrix3d before = belief.pose_covariance();
  const Se2 mean = belief.map_from_base();
  Eigen::Matrix<double, 3, Eigen::Dynamic> axes(3, 1);
  axes.col(0) = Eigen::Vector3d::UnitZ();
  belief.draw_pose(axes, {1.5, 0.0, 0.0});
  EXPECT_NEAR(belief.pose_covariance()(2, 2), 0.0, 1e-12);
  EXPECT_NEAR(belief.map_from_base().theta(), mean.theta() + 1.5 * std::sqrt(before(2, 2)), 1e-9);
  EXPECT_GT(belief.pose_covariance()(0, 0), 0.5 * before(0, 0));
}

TEST(Belief, CorrectingThePoseMovesTheMarkersThatHangOnIt) {
  Belief belief{{OdometryNoise{}, 0.0, 0.0}};
  belief.move(kForward, {});
  belief.add(measurement_at({1.5, 1.0, -1.57}));
  const Se2 before = belief.map_from_base();
  const double marker_x = belief.markers()[0].map_from_marker.x();
  belief.correct_pose({before.x() + 0.01, before.y(), before.theta()},
                      1e-12 * Eigen::Matrix3d::Identity());
  EXPECT_NEAR(belief.markers()[0].map_from_marker.x(), marker_x + 0.01, 1e-6);
}

// A pose that is drawn again and again must not make the errors of the odometry known.
TEST(Belief, DrawingThePoseTellsNothingOfSystematicErrors) {
  Belief belief{{OdometryNoise{}, 0.005, 0.002, 0.003}};
  const OdometryErrors errors = belief.odometry_errors();
  const Eigen::Matrix4d covariance = belief.odometry_errors_covariance();
  for (int step = 0; step < 100; ++step) {
    belief.move({Se2{0.1, 0.0, 0.0}, 0.1, 0.0}, {});
    belief.draw_pose(Eigen::Matrix3d::Identity(), {1.0, -1.0, 0.5});
    EXPECT_LT(belief.pose_covariance().norm(), 1e-9);
  }
  EXPECT_EQ(belief.odometry_errors(), errors);
  EXPECT_EQ(belief.odometry_errors_covariance(), covariance);
}

TEST(Belief, APoseThatWasPushedByAnErrorTellsTheErrorWhenItIsCorrected) {
  Belief belief{{OdometryNoise{}, 0.0, 0.0, 0.0}};
  PoseError pushed;
  pushed.by_errors(0, 0) = 3.0;  // 3 m with the wrong scale
  pushed.covariance(0, 0) = 9.0 * belief.errors_covariance()(0, 0) + 1e-6;
  belief.widen(pushed);
  EXPECT_NEAR(belief.pose_covariance()(0, 0), pushed.covariance(0, 0), 1e-9);
  EXPECT_TRUE(belief.pose_error().by_errors.isApprox(pushed.by_errors, 1e-9));
  belief.correct_pose({0.03, 0.0, 0.0}, 1e-12 * Eigen::Matrix3d::Identity());
  EXPECT_NEAR(belief.odometry_errors()[0], 0.01, 1e-4);
}

TEST(Belief, AnIdIsAClass) {
  const Belief belief =
      belief_with({measurement_at({1.0, 1.0, -1.5}, 3), measurement_at({5.0, 1.0, -1.5}, 3)});
  EXPECT_EQ(belief.markers()[1].instance, 1);
  const auto nearest = belief.nearest(measurement_at({4.98, 1.0, -1.5}, 3));
  ASSERT_TRUE(nearest);
  EXPECT_EQ(nearest->marker, 1U);
  EXPECT_FALSE(belief.nearest(measurement_at({1.0, 1.0, -1.5}, 9)));
}

TEST(Belief, SettledMarkersLeaveTheCovarianceAndAreKnownAgain) {
  std::vector<MarkerMeasurement> seen;
  for (int id = 0; id < 6; ++id) {
    seen.push_back(measurement_at({1.0 + id, 1.0, -1.57}, id));
    seen.back().time = Timestamp{std::chrono::seconds{id}};
  }
  Belief belief = belief_with(seen);
  Belief copy = belief;
  belief.settle_oldest(2);
  EXPECT_EQ(belief.markers().size(), 6U);
  EXPECT_EQ(copy.markers().size(), 6U);
  EXPECT_EQ(belief.markers()[0].covariance, copy.markers()[0].covariance);
  EXPECT_EQ(belief.pose_covariance(), copy.pose_covariance());
  const auto nearest = belief.nearest(measurement_at({1.0, 1.0, -1.57}, 0));
  ASSERT_TRUE(nearest);
  belief.correct(nearest->marker, measurement_at({1.0, 1.0, -1.57}, 0), kGate);
  EXPECT_EQ(belief.markers()[0].sightings, 2);
}

TEST(SquarePerspective, TellsTheFocalLengthOfTheCamera) {
  for (const double error : {-0.01, 0.0, 0.02}) {
    std::array<Eigen::Vector2d, 4> corners;
    const double ahead[]{2.4, 2.0, 2.0, 2.4};
    const double down[]{-0.2, -0.2, 0.2, 0.2};
    for (std::size_t i = 0; i < 4; ++i)
      corners[i] = (1.0 + error) * Eigen::Vector2d{-1.0 / ahead[i], down[i] / ahead[i]};
    const auto focal = focal_error_of(corners, 1e-4);
    ASSERT_TRUE(focal);
    EXPECT_NEAR(focal->error, error, 1e-9);
    EXPECT_GT(focal->sigma, 0.0);
  }
}

TEST(SquarePerspective, AViewFromTheFrontTellsNothing) {
  EXPECT_FALSE(focal_error_of({Eigen::Vector2d{-0.1, -0.1}, Eigen::Vector2d{0.1, -0.1},
                               Eigen::Vector2d{0.1, 0.1}, Eigen::Vector2d{-0.1, 0.1}},
                              1e-4));
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
  SurfaceFinder finder{map, beams.size()};
  const Se2 start{0.3, 0.03, 0.02};
  const PoseProposal matched = propose(
      start, diagonal(0.1, 0.1, 0.1), [&](const Se2& pose, const Eigen::Matrix3d& uncertainty) {
        return match_surfaces(beams, finder, pose, uncertainty, {}).pose;
      });
  EXPECT_NEAR(matched.mean.y(), 0.0, 0.003);
  EXPECT_NEAR(matched.mean.theta(), 0.0, 0.003);
  EXPECT_NEAR(matched.mean.x(), 0.3, 0.002);  // nothing pulls
  EXPECT_NEAR(matched.covariance(0, 0), 0.01, 0.001);
}

TEST(NoiseOfWalls, IsThatOfTheScansBestFit) {
  Random random{8};
  constexpr double kNoise_m = 0.01;
  constexpr int kScans = 300;
  SurfaceMatchingConfig config;
  config.surface_sigma_m = 1e-6;
  double squares = 0.0;
  Eigen::Matrix3d told = Eigen::Matrix3d::Zero();
  for (int scan = 0; scan < kScans; ++scan) {
    const auto beams = corridor_beams(kNoise_m, random);
    told += noise_of_walls(beams, config) / kScans;
    // Least squares of the heading, which symmetry makes independent of all else.
    double weights = 0.0;
    double sum = 0.0;
    for (const AnnotatedBeam& annotated : beams) {
      const Eigen::Vector2d& end = annotated.beam.end_in_base;
      const double across_m = end.y() > 0.0 ? end.y() - 1.0 : end.y() + 1.0;
      const double weight = end.squaredNorm();  // the noise across the wall falls with the range
      weights += weight * end.x() * end.x();
      sum += weight * end.x() * across_m;
    }
    squares += std::pow(sum / weights, 2) / kScans;
  }
  EXPECT_NEAR(std::sqrt(told(2, 2) / squares), 1.0, 0.15);
  EXPECT_NEAR(told(0, 0), 0.0, 1e-12) << "a bare corridor tells nothing along it";
}

TEST(SurfaceFinder, FindsWhatTheMapHas) {
  Random random{9};
  SurfaceMap map{GridFrame::centred_on_map_origin(0.05)};
  for (const AnnotatedBeam& beam : corridor_beams(0.01, random))
    map.add(beam.beam.end_in_base);
  SurfaceFinder finder{map, 1};
  Eigen::Vector2d point{0.5, 0.95};
  for (int i = 0; i < 2000; ++i) {
    point += 0.01 * Eigen::Vector2d{random.normal(), 0.3 * random.normal()};
    const double reach_m = random.uniform() < 0.5 ? 0.05 : 0.3;
    const auto expected = map.near(point, reach_m);
    const auto found = finder.near(0, point, reach_m);
    ASSERT_EQ(found.has_value(), expected.has_value());
    if (found) {
      ASSERT_EQ(found->point_in_map, expected->point_in_map);
    }
  }
}

TEST(SurfaceMatching, AClumpTellsThePlaceAndALineOnlyTheDistance) {
  const GridFrame frame = GridFrame::centred_on_map_origin(0.05);
  Random random{5};
  const auto match_of = [&](double length_m, double uncertainty_m = 0.1) {
    SurfaceMap map{frame};
    for (int i = 0; i < 400; ++i)
      map.add({2.0 + 0.01 * random.normal(), length_m * (random.uniform() - 0.5)});
    std::vector<AnnotatedBeam> beams(1);
    beams[0].beam.end_in_base = {2.0, 0.02};
    beams[0].beam.range_m = 2.0;
    SurfaceMatchingConfig config;
    config.weak_share = 0.0;
    SurfaceFinder finder{map, beams.size()};
    const double variance_m2 = uncertainty_m * uncertainty_m;
    return match_surfaces(beams, finder, {}, diagonal(variance_m2, variance_m2, 0.0), config)
        .pose.information;
  };
  const Eigen::Matrix3d line = match_of(2.0);
  const Eigen::Matrix3d clump = match_of(0.04);
  EXPECT_LT(line(1, 1), 0.01 * line(0, 0));
  EXPECT_GT(clump(1, 1), 0.1 * clump(0, 0));
  EXPECT_LT(match_of(0.04, 0.001)(1, 1), 0.2 * clump(1, 1)) << "the place is known better already";
}

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

TEST(MeasureMarkers, OdometryBetweenFrameAndScanTurnsASightingAboutTheRobot) {
  Observation observation;  // without walls: what the camera says
  MarkerSighting sighting;
  sighting.base_from_marker = {2.0, 1.0, radians(-90.0)};
  sighting.covariance_in_base = 1e-6 * Eigen::Matrix3d::Identity();
  observation.sightings = {sighting};
  const OdometryNoise odometry;
  const auto covariance_of = [&] {
    return measure_markers(observation, 0.01, {}, odometry, {}).at(0).covariance;
  };
  const Eigen::Matrix3d at_once = covariance_of();
  observation.sightings[0].carried_m = 0.05;
  const Eigen::Matrix3d more = covariance_of() - at_once;
  const double turn_rad2 = odometry.turn_per_sqrt_m * odometry.turn_per_sqrt_m * 0.05;
  EXPECT_NEAR(more(2, 2), turn_rad2, 1e-12);
  EXPECT_NEAR(more(0, 0), 1.0 * turn_rad2, 1e-12) << "a metre to the left moves along x";
  EXPECT_NEAR(more(1, 1), 4.0 * turn_rad2, 1e-12);
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
  const auto upright = measure_markers(observation, 0.01, {0.07, 0.0, 0.0}, {}, {});
  ASSERT_EQ(upright.size(), 1U);
  EXPECT_TRUE(upright[0].wall.has_value());
  EXPECT_NEAR(upright[0].base_from_marker.y(), 1.0, 0.006);
  EXPECT_LT(upright[0].covariance(0, 0), 2.0 * sighting.covariance_in_base(0, 0));
  observation.sightings[0].base_from_marker = {2.5, 1.01, radians(-130.0)};
  const auto flipped = measure_markers(observation, 0.01, {0.07, 0.0, 0.0}, {}, {});
  EXPECT_TRUE(flipped.empty());
}

}  // namespace
}  // namespace waymark
