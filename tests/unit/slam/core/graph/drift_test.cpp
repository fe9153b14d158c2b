// SPDX-License-Identifier: BSD-3-Clause
// How far poses may have drifted from each other.
#include "slam/core/graph/drift.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace waymark {
namespace {

constexpr double kApart_m = 0.25;
constexpr double kTurnSigma_rad = 0.01;
constexpr int kTurnsAt = 20;

/// Pose of a keyframe: straight ahead, then from one keyframe on sideways to the left.
Se2 place(int keyframe) {
  const int ahead = std::min(keyframe, kTurnsAt);
  return {5.0 + kApart_m * ahead, 2.0 + kApart_m * (keyframe - ahead), 0.0};
}

/// Drift of keyframes with errors in the heading only.
DriftCovariance drift_of_headings(int keyframes) {
  DriftCovariance drift;
  for (int k = 0; k < keyframes; ++k) {
    const double sigma_rad = k == 0 ? 0.0 : kTurnSigma_rad;
    drift.add_keyframe(place(k), Eigen::Vector3d{0.0, 0.0, sigma_rad * sigma_rad}.asDiagonal());
  }
  return drift;
}

TEST(DriftCovariance, AHeadingErrorMovesThePositionByItsLeverArm) {
  constexpr int kNewest = 30;
  const DriftCovariance drift = drift_of_headings(kNewest + 1);
  for (const int since : {0, 7, 25, kNewest}) {
    Eigen::Matrix3d expected = Eigen::Matrix3d::Zero();
    for (int k = since + 1; k <= kNewest; ++k) {
      const Eigen::Vector2d way = place(kNewest).translation() - place(k).translation();
      const Eigen::Vector3d by_turn{-way.y(), way.x(), 1.0};
      expected += kTurnSigma_rad * kTurnSigma_rad * by_turn * by_turn.transpose();
    }
    EXPECT_LT((drift.since(static_cast<std::size_t>(since)) - expected).norm(), 1e-12) << since;
  }
}

TEST(DriftCovariance, BetweenTwoKeyframesIsTheSumOfTheirStepsAtTheNewestOne) {
  const DriftCovariance drift = drift_of_headings(31);
  const Eigen::Matrix3d between = drift.between(7, 25);
  EXPECT_LT((between - (drift.since(7) - drift.since(25))).norm(), 1e-12);
  EXPECT_LT((between - drift.between(25, 7)).norm(), 1e-12);
  EXPECT_TRUE(drift.between(9, 9).isZero());
}

TEST(DriftCovariance, IsInvariantUnderAChangeOfFrame) {
  DriftCovariance drift = drift_of_headings(30);
  const Se2 new_from_old{-40.0, 13.0, 2.0};
  const Eigen::Matrix3d before = drift.since(3);
  drift.move_to_frame(new_from_old);
  EXPECT_LT((drift.since(3) - in_axes(new_from_old.rotation(), before)).norm(), 1e-12);
}

}  // namespace
}  // namespace waymark
