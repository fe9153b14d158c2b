// SPDX-License-Identifier: BSD-3-Clause
// A graph keeps its shape when all of it turns; a slip is distinguished from an outdated pose.
#include "slam/core/graph/graph.hpp"

#include <gtest/gtest.h>

namespace waymark {
namespace {

constexpr std::size_t kKeyframes = 30;
constexpr std::size_t kWindow = 10;
constexpr double kStep_m = 0.2;
constexpr double kTurn_rad = 0.05;  // per step

Motion step_of(double distance_m) {
  return Motion::between({}, {distance_m, 0.0, kTurn_rad});
}

/// A drive along an arc whose beginning the first pose knows as well as these sigmas say.
Graph drive(const GraphNoise& noise, double heading_sigma_rad, double scale_sigma,
            double measured_scale) {
  Calibration sigmas = Calibration::Constant(1e-3);
  sigmas[0] = scale_sigma;
  Graph graph{noise, sigmas};
  graph.add_keyframe({});
  const Eigen::Vector3d first{1e-4, 1e-4, heading_sigma_rad};
  graph.add(PosePrior{0, {}, first.cwiseInverse().asDiagonal()});
  const Motion motion = step_of(measured_scale * kStep_m);
  for (std::size_t k = 1; k < kKeyframes; ++k) {
    graph.add_keyframe(graph.state().keyframes.back() * motion.start_from_end);
    graph.add(OdometryFactor{k - 1, k, motion});
    graph.optimise();
    while (graph.num_active_keyframes() > kWindow)
      graph.marginalise_oldest(1e9);
  }
  return graph;
}

void tie_newest_to(Graph& graph, const Se2& pose) {
  const std::size_t newest = graph.state().keyframes.size() - 1;
  graph.add(PosePrior{newest, pose, 1e5 * Eigen::Matrix3d::Identity()});
}

TEST(GraphFrames, AWindowThatTurnsAsAWholeKeepsItsShape) {
  GraphNoise noise;
  noise.odometry.may_slip = false;
  Graph graph = drive(noise, 3.0, 1e-4, 1.0);
  const Se2 turn{0.0, 0.0, 0.1};
  const PoseSequence before = graph.state().keyframes;
  tie_newest_to(graph, turn * before.back());
  graph.optimise();
  for (std::size_t k = kKeyframes - kWindow; k < kKeyframes; ++k) {
    const Eigen::Vector3d off = pose_difference(graph.state().keyframes[k], turn * before[k]);
    EXPECT_LT(off.norm(), 5e-3) << "keyframe " << k;
  }
}

TEST(GraphFrames, CovariancesAreInTheMapsAxes) {
  Graph graph = drive({}, 0.1, 1e-4, 1.0);
  const Se2& newest = graph.state().keyframes.back();
  const Eigen::Matrix3d covariance = graph.covariance_of({VariableKind::kKeyframe, kKeyframes - 1});
  // The heading of the first pose moves the newest one sideways, as seen from there.
  const Eigen::Vector3d swings{-newest.y(), newest.x(), 1.0};
  const Eigen::Vector3d axis = swings.normalized();
  EXPECT_GT(axis.dot(covariance * axis) / covariance.trace(), 0.95);
}

/// The poses outside the window follow a new calibration with the next solution of the whole graph.
TEST(GraphFrames, AChangeOfTheCalibrationIsNotTakenForASlip) {
  constexpr double kScale = 1.03;
  Graph graph = drive({}, 1e-4, 0.05, kScale);
  Se2 truth;
  for (std::size_t k = 1; k < kKeyframes; ++k)
    truth = truth * step_of(kStep_m).start_from_end;
  tie_newest_to(graph, truth);
  graph.optimise();
  ASSERT_NEAR(graph.state().calibration[0], 1.0 / kScale - 1.0, 0.01);
  const double known = graph.covariance({}, {})(0, 0);
  graph.step_all();
  EXPECT_LT(graph.covariance({}, {})(0, 0), 1.5 * known);
}

TEST(GraphFrames, AfterARelocalisationEachMeasurementCountsOnce) {
  Graph graph = drive({}, 1e-4, 1e-4, 1.0);
  tie_newest_to(graph, graph.state().keyframes.back());
  const Se2 elsewhere{50.0, 0.0, 1.0};
  graph.relocate_newest(elsewhere);
  const Motion motion = step_of(kStep_m);
  graph.add_keyframe(elsewhere * motion.start_from_end);
  graph.add(OdometryFactor{kKeyframes - 1, kKeyframes, motion});
  graph.optimise();
  const Eigen::Matrix3d of_step = graph.covariance_of_newest_step();
  EXPECT_NEAR(of_step(2, 2), random_walk(motion, OdometryNoise{})(2, 2), 0.1 * of_step(2, 2));
}

/// Odometry stood still since a keyframe outside the window, so that only a step of the whole graph
/// could use its factor.
TEST(GraphFrames, ARelocatedPoseDoesNotDependOnEarlierPoses) {
  constexpr double kSigma_m = 0.3;
  Graph graph = drive({}, 1e-4, 1e-4, 1.0);
  const std::size_t newest = graph.add_keyframe(graph.state().keyframes[1]);
  graph.add(OdometryFactor{1, newest, Motion{}});
  graph.step_all();
  const Se2 elsewhere{50.0, 0.0, 1.0};
  graph.relocate_newest(elsewhere);
  graph.add(PosePrior{newest, elsewhere, Eigen::Matrix3d::Identity() / kSigma_m});
  graph.optimise();
  EXPECT_NEAR(graph.covariance_of({VariableKind::kKeyframe, newest})(0, 0), kSigma_m * kSigma_m,
              1e-3);
  const Eigen::Vector3d off = pose_difference(graph.state().keyframes.back(), elsewhere);
  EXPECT_LT(off.norm(), 1e-4);
}

}  // namespace
}  // namespace waymark
