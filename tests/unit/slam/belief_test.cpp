// SPDX-License-Identifier: BSD-3-Clause
// What one particle knows, against something slow and obvious.
#include "slam/core/belief/belief.hpp"

#include "support/small_world.hpp"

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include <array>
#include <chrono>
#include <cmath>
#include <utility>
#include <vector>

namespace waymark {
namespace {

using test::diagonal;
using test::measurement_of;

Belief belief_with(const std::vector<MarkerMeasurement>& measurements) {
  Belief belief{{OdometryNoise{}, {0.005, 0.002, 0.0}}};
  for (const MarkerMeasurement& measurement : measurements)
    belief.add(measurement);
  return belief;
}

/// Markers 0 to 5 in a row, a metre and a second apart.
Belief belief_with_six_markers() {
  std::vector<MarkerMeasurement> seen;
  for (int id = 0; id < 6; ++id) {
    seen.push_back(measurement_of({1.0 + id, 1.0, -1.57}, id));
    seen.back().time = Timestamp{std::chrono::seconds{id}};
  }
  return belief_with(seen);
}

constexpr double kGate = 16.3;  // chi^2, 3 degrees of freedom: 99.9 %
const Motion kForward{Se2{0.5, 0.0, 0.02}, 0.5, 0.02};

TEST(OdometryErrors, DerivativesAgreeWithDifferences) {
  constexpr double kStep = 1e-6;
  const Motion motion{Se2{0.3, 0.05, 0.8}, 0.31, 0.8};
  const OdometryErrors errors{0.01, 0.02, -0.03, 0.04, 0.0};
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
  const Se2 moved =
      corrected_motion(left, OdometryErrors{0.0, 0.0, 0.0, 0.2, 0.0}, {}).start_from_end;
  EXPECT_NEAR(moved.x(), -0.2, 2e-3);
  EXPECT_NEAR(moved.y(), 0.2, 2e-3);
}

TEST(OdometryErrors, ATurnWithinItsNoiseTellsNothingOfTheScaleOfTurns) {
  const Motion straight{Se2{0.1, 0.0, 0.003}, 0.1, 0.003};
  EXPECT_TRUE(corrected_motion(straight, OdometryErrors::Zero(), {}).by_errors.col(2).isZero());
}

TEST(Belief, IsUnsureAlongTheWayAndAMarkerMakesItSurer) {
  Belief belief = belief_with({measurement_of({2.0, 1.0, -1.57})});
  belief.move(kForward, {});
  const Eigen::Matrix3d before = belief.pose_covariance();
  EXPECT_GT(before(0, 0), 0.0);
  const Se2 base_from_marker = belief.map_from_base().inverse() * Se2{2.0, 1.0, -1.57};
  const auto nearest = belief.nearest(measurement_of(base_from_marker));
  ASSERT_TRUE(nearest);
  EXPECT_NEAR(nearest->distance, 0.0, 1e-9);
  belief.correct(nearest->marker, measurement_of(base_from_marker), kGate);
  EXPECT_LT(belief.pose_covariance()(0, 0), before(0, 0));
  EXPECT_EQ(belief.markers()[0].sightings, 2);
}

TEST(Belief, LearnsTheScaleOfTheOdometryFromAMarker) {
  Belief belief = belief_with({measurement_of({3.0, 1.0, -1.57})});
  double true_x = 0.0;
  for (int i = 0; i < 40; ++i) {
    belief.move({Se2{0.05, 0.0, 0.0}, 0.05, 0.0}, {});
    true_x += 0.05 * 1.01;
    belief.correct(0, measurement_of({3.0 - true_x, 1.0, -1.57}), kGate);
  }
  const double sigma = std::sqrt(belief.odometry_errors_covariance()(0, 0));
  EXPECT_NEAR(belief.odometry_errors()[0], 0.01, 3.0 * sigma);
  EXPECT_LT(sigma, 0.01);
  EXPECT_NEAR(belief.map_from_base().x(), true_x, 0.02);
}

TEST(Belief, DrawingAnAxisMakesItExactAndLeavesTheOthers) {
  Belief belief = belief_with({measurement_of({2.0, 1.0, -1.57})});
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
  Belief belief{{OdometryNoise{}, Eigen::Vector3d::Zero()}};
  belief.move(kForward, {});
  belief.add(measurement_of({1.5, 1.0, -1.57}));
  const Se2 before = belief.map_from_base();
  const double marker_x = belief.markers()[0].map_from_marker.x();
  belief.correct_pose({before.x() + 0.01, before.y(), before.theta()},
                      1e-12 * Eigen::Matrix3d::Identity());
  EXPECT_NEAR(belief.markers()[0].map_from_marker.x(), marker_x + 0.01, 1e-6);
}

// A pose that is drawn again and again must not make the errors of the odometry known.
TEST(Belief, DrawingThePoseTellsNothingOfSystematicErrors) {
  Belief belief{{OdometryNoise{}, {0.005, 0.002, 0.003}}};
  const OdometryErrors errors = belief.odometry_errors();
  const Eigen::MatrixXd covariance = belief.odometry_errors_covariance();
  for (int step = 0; step < 100; ++step) {
    belief.move({Se2{0.1, 0.0, 0.0}, 0.1, 0.0}, {});
    belief.draw_pose(Eigen::Matrix3d::Identity(), {1.0, -1.0, 0.5});
    EXPECT_LT(belief.pose_covariance().norm(), 1e-9);
  }
  EXPECT_EQ(belief.odometry_errors(), errors);
  EXPECT_EQ(belief.odometry_errors_covariance(), covariance);
}

// Whichever way it turns the robot, and whichever way the robot looks.
TEST(Belief, WhatASlipCostsAlongTheWayIsLearntAndTakenOffTheNext) {
  constexpr double kHalfTrack_m = 0.12;
  for (const double turn_rad : {0.1, -0.1}) {
    Belief belief{{OdometryNoise{}, Eigen::Vector3d::Zero()}};
    belief.step({1.0, 2.0, 0.7});
    const Motion motion{Se2{0.2, 0.0, 0.0}, 0.2, 0.0};
    const double expected_m = OdometryNoise{}.half_track_m * std::abs(turn_rad);
    const auto behind = [&](double way_m) {
      return belief.map_from_base() * Se2{-way_m, 0.0, 0.0};
    };
    belief.slip(motion, turn_rad);
    const Eigen::Matrix3d in_base =
        turned(belief.map_from_base().inverse(), belief.pose_covariance());
    EXPECT_NEAR(std::sqrt(in_base(0, 0)), expected_m, 1e-9);
    EXPECT_NEAR(in_base(1, 1), 0.0, 1e-12);

    const double lost_m = kHalfTrack_m * std::abs(turn_rad);
    belief.correct_pose(behind(lost_m), 1e-8 * Eigen::Matrix3d::Identity());
    EXPECT_NEAR(belief.odometry_errors()[kSpin], -kHalfTrack_m, 1e-3);

    const Se2 expected = behind(2.0 * lost_m);
    belief.slip(motion, -2.0 * turn_rad);
    EXPECT_LT(deviation(expected, belief.map_from_base()).norm(), 1e-3);
  }
}

TEST(Belief, APoseThatWasPushedByAnErrorTellsTheErrorWhenItIsCorrected) {
  Belief belief{{OdometryNoise{}, Eigen::Vector3d::Zero()}};
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
      belief_with({measurement_of({1.0, 1.0, -1.5}, 3), measurement_of({5.0, 1.0, -1.5}, 3)});
  EXPECT_EQ(belief.markers()[1].instance, 1);
  const auto nearest = belief.nearest(measurement_of({4.98, 1.0, -1.5}, 3));
  ASSERT_TRUE(nearest);
  EXPECT_EQ(nearest->marker, 1U);
  EXPECT_FALSE(belief.nearest(measurement_of({1.0, 1.0, -1.5}, 9)));
}

TEST(Belief, SettledMarkersLeaveTheCovarianceAndAreKnownAgain) {
  Belief belief = belief_with_six_markers();
  Belief copy = belief;
  belief.settle_oldest(2);
  EXPECT_EQ(belief.markers().size(), 6U);
  EXPECT_EQ(copy.markers().size(), 6U);
  EXPECT_EQ(belief.markers()[0].covariance, copy.markers()[0].covariance);
  EXPECT_EQ(belief.pose_covariance(), copy.pose_covariance());
  const auto nearest = belief.nearest(measurement_of({1.0, 1.0, -1.57}, 0));
  ASSERT_TRUE(nearest);
  belief.correct(nearest->marker, measurement_of({1.0, 1.0, -1.57}, 0), kGate);
  EXPECT_EQ(belief.markers()[0].sightings, 2);
}

TEST(Belief, ForgetsWhatIsNewWhetherItHasSettledOrNot) {
  for (const std::size_t active : {6U, 2U, 0U}) {
    Belief belief = belief_with_six_markers();
    belief.settle_oldest(active);
    const Belief copy = belief;
    belief.forget_since(Timestamp{std::chrono::seconds{2}});
    std::vector<int> ids;
    for (const Landmark& marker : belief.markers())
      ids.push_back(marker.id);
    EXPECT_EQ(ids, (std::vector{0, 1, 2})) << active << " have not settled";
    EXPECT_EQ(copy.markers().size(), 6U);
    EXPECT_FALSE(belief.nearest(measurement_of({4.0, 1.0, -1.57}, 3)));
    EXPECT_TRUE(belief.nearest(measurement_of({3.0, 1.0, -1.57}, 2)));
  }
}

}  // namespace
}  // namespace waymark
