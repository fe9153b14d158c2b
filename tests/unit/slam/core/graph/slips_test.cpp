// SPDX-License-Identifier: BSD-3-Clause
// Slips that only many measurements together show.
#include "slam/core/graph/graph.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace waymark {
namespace {

constexpr double kStride_m = 0.18;
constexpr std::size_t kStrides = 12;
constexpr std::size_t kSlipsAt = 7;  // the motion to this keyframe
constexpr double kSlip_m = 0.045;
constexpr double kScaleSigma = 0.02;

MarkerFactor sighting(std::size_t keyframe, const Se2& base_from_marker, double sigma_m) {
  MarkerFactor factor;
  factor.keyframe = keyframe;
  factor.measurement.base_from_marker = base_from_marker;
  factor.root_information = Eigen::Vector3d{1.0 / sigma_m, 1.0 / sigma_m, 50.0}.asDiagonal();
  return factor;
}

/// A straight drive towards a marker, which every keyframe measures to `sigma_m`. Odometry is exact
/// but for one slip.
Graph drive_with_slip(double slip_m, double sigma_m) {
  Calibration sigmas = Calibration::Constant(1e-6);
  sigmas[OdometryTerm::kScale] = kScaleSigma;
  Graph graph{{}, sigmas};
  graph.add_keyframe({});
  graph.add(PosePrior{0, {}, 1e4 * Eigen::Matrix3d::Identity()});
  const Se2 marker{4.0, 1.0, -1.5};
  const std::size_t landmark = graph.add_landmark(marker);
  for (std::size_t k = 0; k < kStrides; ++k) {
    const Se2 truth{kStride_m * static_cast<double>(k), 0.0, 0.0};
    if (k > 0) {
      const Motion motion =
          Motion::between({}, {kStride_m + (k == kSlipsAt ? slip_m : 0.0), 0.0, 0.0});
      graph.add_keyframe(graph.state().keyframes.back() * motion.start_from_end);
      graph.add(OdometryFactor{k - 1, k, motion});
    }
    MarkerFactor seen = sighting(k, truth.inverse() * marker, sigma_m);
    seen.landmark = landmark;
    graph.add(seen);
    graph.optimise();
  }
  return graph;
}

TEST(Slips, ASingleSlipIsNotTakenForAWrongOdometryScale) {
  const Graph graph = drive_with_slip(kSlip_m, 0.008);
  const double sigma = std::sqrt(graph.covariance({}, {})(0, 0));
  EXPECT_LT(std::abs(graph.state().calibration[OdometryTerm::kScale]), sigma);
  EXPECT_NEAR(graph.state().keyframes.back().x(), kStride_m * (kStrides - 1), 0.01);
}

TEST(Slips, CorrectOdometryGivesNoSlip) {
  const Graph right = drive_with_slip(0.0, 0.015);
  Graph again = right;
  again.optimise();
  EXPECT_NEAR(again.cost(), right.cost(), 1e-6);
  EXPECT_LT(right.cost(), 1e-3);
}

TEST(Slips, WithoutMarkersASlipIsTakenForAWrongScale) {
  GraphNoise noise;
  Calibration sigmas = Calibration::Constant(1e-6);
  sigmas[OdometryTerm::kScale] = kScaleSigma;
  Graph graph{noise, sigmas};
  graph.add_keyframe({});
  graph.add(PosePrior{0, {}, 1e4 * Eigen::Matrix3d::Identity()});
  for (std::size_t k = 1; k < kStrides; ++k) {
    const Motion motion =
        Motion::between({}, {kStride_m + (k == kSlipsAt ? kSlip_m : 0.0), 0.0, 0.0});
    graph.add_keyframe(graph.state().keyframes.back() * motion.start_from_end);
    graph.add(OdometryFactor{k - 1, k, motion});
    graph.add(PosePrior{k,
                        {kStride_m * static_cast<double>(k), 0.0, 0.0},
                        Eigen::Vector3d{125.0, 125.0, 50.0}.asDiagonal()});
    graph.optimise();
  }
  EXPECT_LT(graph.state().calibration[OdometryTerm::kScale], -0.005);
}

/// With exactly known poses, the gain of best_change() is the difference of the two costs.
TEST(Slips, ThePredictedCostReductionIsExactForFixedPoses) {
  const Motion motion = Motion::between({}, {kStride_m, 0.0, 0.0});
  OdometryFactor factor{0, 1, motion};
  State state;
  const double off_m = 0.006;
  state.keyframes = {{}, {kStride_m + off_m, 0.0, 0.0}};
  const OdometryNoise noise;
  const LinearFactor linear = factor.linearise(state, noise);
  const OdometryFactor::Change change =
      factor.best_change(linear, Eigen::Matrix3d::Zero(), state, noise, {});
  const double before = factor.cost(state, noise, {});
  ASSERT_EQ(change.kind, MotionKind::kBothSlip);
  factor.kind = change.kind;
  EXPECT_NEAR(change.gain, before - factor.cost(state, noise, {}), 1e-9);
}

}  // namespace
}  // namespace waymark
