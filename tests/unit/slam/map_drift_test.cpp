// SPDX-License-Identifier: BSD-3-Clause
// Unit tests of how far the map may have drifted.
#include "slam/core/mapping/map_drift.hpp"

#include <Eigen/Eigenvalues>
#include <gtest/gtest.h>

namespace waymark {
namespace {

const Observability kTellsAlong{Eigen::Matrix3d::Identity(), Eigen::Vector2d::UnitX(), 1.0, false};
const Eigen::Matrix3d kNone = Eigen::Matrix3d::Zero();

/// Two walls along x, a metre away on both sides.
std::vector<AnnotatedBeam> between_walls() {
  std::vector<AnnotatedBeam> beams;
  for (int side : {1, -1}) {
    for (int i = -20; i <= 20; ++i) {
      AnnotatedBeam annotated;
      annotated.beam.end_in_base = {0.1 * side * i, side};
      annotated.beam.range_m = annotated.beam.end_in_base.norm();
      beams.push_back(annotated);
    }
  }
  return beams;
}

PoseError independent(double x, double y, double theta) {
  return {Eigen::Vector3d{x, y, theta}.asDiagonal(), PoseByErrors::Zero()};
}

/// Off to the left by the first of the systematic errors.
PoseError following(double error_variance) {
  PoseError error;
  error.by_errors(1, 0) = 1.0;
  error.covariance(1, 1) = error_variance;
  return error;
}

const ErrorsCovariance kErrors = 1e-4 * ErrorsCovariance::Identity();

TEST(MapDrift, WhatCameSinceIsReleasedWhereTheMapIsOlder) {
  MapDrift drift;
  drift.take(independent(0.0, 1e-4, 1e-6), kNone, kErrors);
  drift.map(between_walls(), kNone, {}, kErrors);
  drift.move({50.0, 0.0, 0.0});
  EXPECT_NEAR(drift.now().covariance(1, 1), 1e-4 + 2500.0 * 1e-6, 1e-9)
      << "headings turn into positions";
  EXPECT_NEAR(drift.now().covariance(1, 2), 50.0 * 1e-6, 1e-12)
      << "turned left means off to the left";
  drift.take(independent(0.0, 3e-4, 0.0), kNone, kErrors);
  EXPECT_TRUE(drift.release(between_walls(), kTellsAlong, kErrors).since.covariance.isZero(1e-12))
      << "nothing is known here";
  drift.move({0.0, 0.0, 0.0});
  const PoseError since = drift.release(between_walls(), kTellsAlong, kErrors).since;
  EXPECT_NEAR(since.covariance(1, 1), 3e-4, 1e-9);
  EXPECT_NEAR(drift.now().covariance(1, 1), 1e-4, 1e-9);
}

TEST(MapDrift, WallsAlongACorridorReleaseNothingAlongIt) {
  MapDrift drift;
  drift.map(between_walls(), kNone, {}, kErrors);
  drift.take(independent(4e-4, 1e-4, 0.0), kNone, kErrors);
  const PoseError since = drift.release(between_walls(), kTellsAlong, kErrors).since;
  EXPECT_NEAR(since.covariance(0, 0), 0.0, 1e-12);
  EXPECT_NEAR(since.covariance(1, 1), 1e-4, 1e-9);
  EXPECT_NEAR(drift.now().covariance(0, 0), 4e-4, 1e-12);
}

TEST(MapDrift, SystematicErrorsAddUpAndOthersAddTheirSquares) {
  MapDrift systematic;
  MapDrift random;
  for (int step = 0; step < 10; ++step) {
    systematic.take(following(1e-4), kNone, kErrors);
    random.take(independent(0.0, 1e-4, 0.0), kNone, kErrors);
  }
  EXPECT_NEAR(systematic.now().covariance(1, 1), 100.0 * 1e-4, 1e-9);
  EXPECT_NEAR(random.now().covariance(1, 1), 10.0 * 1e-4, 1e-9);
}

TEST(MapDrift, WhatIsReleasedSaysWhichErrorsItFollows) {
  MapDrift drift;
  drift.take(following(1e-4), kNone, kErrors);
  drift.map(between_walls(), kNone, {}, kErrors);
  drift.take(following(1e-4), kNone, kErrors);
  drift.take(following(1e-4), kNone, kErrors);
  const PoseError since = drift.release(between_walls(), kTellsAlong, kErrors).since;
  EXPECT_NEAR(since.by_errors(1, 0), 2.0, 1e-12);
  EXPECT_NEAR(drift.now().by_errors(1, 0), 1.0, 1e-12);
  EXPECT_NEAR(drift.now().covariance(1, 1), 1e-4, 1e-9);
}

TEST(MapDrift, APlaceHasTheMeanErrorOfItsScans) {
  MapDrift drift;
  drift.take(independent(0.0, 1e-4, 0.0), kNone, kErrors);
  drift.map(between_walls(), kNone, {}, kErrors);
  drift.take(independent(0.0, 2e-4, 0.0), kNone, kErrors);
  drift.map(between_walls(), kNone, {}, kErrors);
  EXPECT_NEAR(drift.release(between_walls(), kTellsAlong, kErrors).since.covariance(1, 1), 1e-4,
              1e-9);
  EXPECT_NEAR(drift.now().covariance(1, 1), 2e-4, 1e-9);
}

/// Those that end further along than x, and the others.
std::vector<AnnotatedBeam> part_of_walls(bool is_ahead) {
  std::vector<AnnotatedBeam> beams = between_walls();
  std::erase_if(beams, [&](const AnnotatedBeam& annotated) {
    const double x = annotated.beam.end_in_base.x();
    return is_ahead ? x < 0.05 : x > -0.05;
  });
  return beams;
}

TEST(MapDrift, OldAndNewWallsPullAsMuchAsTheyTell) {
  MapDrift drift;
  drift.map(part_of_walls(false), kNone, {}, kErrors);
  drift.take(independent(0.0, 1e-4, 0.0), kNone, kErrors);
  drift.map(part_of_walls(true), kNone, {}, kErrors);
  drift.release(between_walls(), kTellsAlong, kErrors);
  const Eigen::Matrix3d now = drift.now().covariance;
  EXPECT_NEAR(now(1, 1), 0.25e-4, 0.03e-4) << "off by half as much in the middle of both";
  EXPECT_GT(now(2, 2), 0.03e-4) << "and turned towards the new ones";
  EXPECT_GT(now(1, 2), 0.0);
}

TEST(MapDrift, WallsThatWereMappedFromABetterPoseAreNotDoubled) {
  MapDrift drift;
  for (int scan = 0; scan < 8; ++scan)
    drift.map(part_of_walls(false), kNone, {}, kErrors);
  drift.take(independent(0.0, 0.01 * 0.01, 0.0), kNone, kErrors);
  drift.release(between_walls(), kTellsAlong, kErrors);
  EXPECT_FALSE(drift.is_better_known({-1.5, 1.0})) << "10 mm are no reason";
  drift.take(independent(0.0, 0.015 * 0.015, 0.0), kNone, kErrors);
  drift.release(between_walls(), kTellsAlong, kErrors);
  EXPECT_TRUE(drift.is_better_known({-0.5, 1.0}));
  EXPECT_FALSE(drift.is_better_known({0.5, 1.0})) << "nothing is known there";
}

TEST(MapDrift, TheNoiseOfAScanStaysOnlyInWhatItWasNotMatchedTo) {
  MapDrift drift;
  drift.take(independent(0.0, 3e-4, 0.0), Eigen::Vector3d{0.0, 1e-4, 0.0}.asDiagonal(), kErrors);
  for (int scan = 0; scan < 4; ++scan)
    drift.map(between_walls(), kNone, {}, kErrors);
  EXPECT_NEAR(drift.release(between_walls(), kTellsAlong, kErrors).since.covariance(1, 1), 0.75e-4,
              1e-9);
  EXPECT_NEAR(drift.now().covariance(1, 1), 2.25e-4, 1e-9);
}

TEST(MapDrift, WallsMayBeWorseThanThePoseTheyWereMappedFrom) {
  MapDrift drift;
  drift.map(between_walls(), Eigen::Vector3d{0.0, 1e-4, 1e-6}.asDiagonal(), {}, kErrors);
  EXPECT_TRUE(drift.now().covariance.isZero());
  const DriftFromWalls off = drift.release(between_walls(), kTellsAlong, kErrors);
  EXPECT_TRUE(off.since.covariance.isZero(1e-12));
  EXPECT_NEAR(off.before(1, 1), 1e-4, 1e-9);
  EXPECT_NEAR(off.before(2, 2), 1e-6, 1e-12);
  EXPECT_NEAR(off.before(0, 0), 0.0, 1e-12) << "these walls tell nothing along them";
  EXPECT_TRUE(drift.now().covariance.isZero(1e-12)) << "seeing them makes the pose no worse";
}

TEST(MapDrift, WallsThatFollowMoreOfASystematicErrorAreOffByThatAlone) {
  MapDrift drift;
  drift.take(following(1e-4), kNone, kErrors);
  drift.map(between_walls(), kNone, {}, kErrors);
  PoseError back = following(1e-4);
  back.by_errors *= -1.0;
  drift.take(back, kNone, kErrors);
  const DriftFromWalls off = drift.release(between_walls(), kTellsAlong, kErrors);
  EXPECT_NEAR(off.since.by_errors(1, 0), -1.0, 1e-12);
  EXPECT_NEAR(off.since.covariance(1, 1), 1e-4, 1e-9);
  EXPECT_TRUE(off.before.isZero(1e-12));
  EXPECT_NEAR(drift.now().covariance(1, 1), 1e-4, 1e-9) << "matching takes over what walls follow";
}

TEST(MapDrift, TheCovarianceOfWhatIsKnownStaysPositive) {
  MapDrift drift;
  for (int step = 0; step < 50; ++step) {
    drift.move({0.3 * step, 0.01 * step, 0.05 * step});
    drift.release(between_walls(), kTellsAlong, kErrors);
    PoseError drawn = following(1e-4);
    drawn.covariance += 1e-6 * Eigen::Matrix3d::Identity();
    drift.take(drawn, 0.5e-6 * Eigen::Matrix3d::Identity(), kErrors);
    drift.map(between_walls(), kNone, {}, kErrors);
    EXPECT_GE(drift.now().covariance.eigenvalues().real().minCoeff(), -1e-12);
  }
}

}  // namespace
}  // namespace waymark
