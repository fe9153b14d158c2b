// SPDX-License-Identifier: BSD-3-Clause
// Factors against numeric derivatives, the window against the whole graph.
#include "slam/core/graph/graph.hpp"

#include "common/random/random.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <gtest/gtest.h>

#include <functional>
#include <vector>

namespace waymark {
namespace {

constexpr double kStep = 1e-6;
constexpr double kGate = kChi2Gate3;

Motion straight(double distance_m, double turn_rad = 0.0) {
  return Motion::between({}, {distance_m, 0.0, turn_rad});
}

State some_state() {
  State state;
  state.keyframes = {{0.3, -0.2, 0.4}, {0.5, -0.1, 0.5}, {0.75, 0.02, 0.55}};
  state.landmarks = {{2.0, 1.0, -1.5}};
  state.calibration << 0.01, 0.005, -0.01, 0.02, 0.004, 0.003, -0.002, 0.001;
  return state;
}

MarkerMeasurement some_measurement() {
  MarkerMeasurement measurement;
  measurement.id = 3;
  measurement.base_from_marker = {1.7, 0.4, -1.9};
  measurement.covariance = Eigen::Vector3d{1e-4, 2e-4, 4e-4}.asDiagonal();
  measurement.base_from_camera = {0.08, 0.0, 0.0};
  measurement.jacobian_view = 0.4 * Eigen::Matrix3d::Identity();
  measurement.jacobian_standoff = {0.1, 0.9, 0.0};
  return measurement;
}

/// Each Jacobian column is the central difference of the residual.
void expect_jacobians_hold(const State& state,
                           const std::function<LinearFactor(const State&)>& linearise) {
  const LinearFactor linear = linearise(state);
  for (const LinearFactor::Block& block : linear.blocks) {
    for (Eigen::Index i = 0; i < block.variable.size(); ++i) {
      Eigen::VectorXd step = Eigen::VectorXd::Zero(block.variable.size());
      step[i] = kStep;
      State ahead = state;
      State behind = state;
      ahead.retract(block.variable, step);
      behind.retract(block.variable, -step);
      const Eigen::Vector3d numeric =
          (linearise(ahead).residual - linearise(behind).residual) / (2.0 * kStep);
      EXPECT_LT((numeric - block.jacobian.col(i)).norm(), 1e-4 * (1.0 + numeric.norm()))
          << "variable kind " << static_cast<int>(block.variable.kind) << " index "
          << block.variable.index << " column " << i;
    }
  }
}

TEST(Factors, JacobianOfOdometryIsTheDerivativeOfItsResidual) {
  const State state = some_state();
  const OdometryFactor factor{0, 1, straight(0.22, 0.09)};
  // The derivative by the calibration is taken at the measured motion, so only poses are compared.
  LinearFactor linear = factor.linearise(state, {});
  ASSERT_EQ(linear.blocks.size(), 3U);
  expect_jacobians_hold(state, [&](const State& at) {
    LinearFactor poses = factor.linearise(at, {});
    poses.blocks.pop_back();
    return poses;
  });
}

TEST(Factors, JacobianOfAScanIsTheDerivativeOfItsResidual) {
  ScanFactor factor;
  factor.keyframe = 2;
  factor.references = {{0, 0.3, {0.5, 0.1, 0.1}}, {1, 0.7, {0.3, 0.0, 0.1}}};
  factor.root_information = root_of(Eigen::Vector3d{1e4, 4e4, 1e5}.asDiagonal());
  expect_jacobians_hold(some_state(), [&](const State& at) { return factor.linearise(at); });
}

TEST(Factors, JacobianOfAMarkerByPosesIsTheDerivativeOfItsResidual) {
  MarkerFactor factor;
  factor.keyframe = 1;
  factor.measurement = some_measurement();
  factor.root_information = root_of(factor.measurement.covariance.inverse());
  State state = some_state();
  state.calibration
      .setZero();  // its Jacobian is taken at the estimated marker: a second-order effect
  expect_jacobians_hold(state, [&](const State& at) { return factor.linearise(at, 1e12); });
}

TEST(Factors, AMarkerFarBeyondTheGateHasLittleInfluence) {
  MarkerFactor factor;
  factor.keyframe = 1;
  factor.measurement = some_measurement();
  factor.root_information = root_of(factor.measurement.covariance.inverse());
  State near = some_state();
  near.calibration.setZero();
  near.landmarks[0] = near.keyframes[1] * factor.measurement.base_from_marker;
  State far = near;
  near.landmarks[0] = {near.landmarks[0].x() + 0.03, near.landmarks[0].y(),
                       near.landmarks[0].theta()};
  far.landmarks[0] = {far.landmarks[0].x() + 3.0, far.landmarks[0].y(), far.landmarks[0].theta()};
  const auto pull = [&](const State& state) {
    const LinearFactor linear = factor.linearise(state, kGate);
    const Eigen::VectorXd gradient = linear.blocks[1].jacobian.transpose() * linear.residual;
    return gradient.norm();
  };
  EXPECT_LT(pull(far), 0.01 * pull(near));
}

/// A drive of short steps past two markers, with noise; every keyframe is tied to the two before.
class Drive {
 public:
  explicit Drive(std::size_t window) : graph_{GraphNoise{}, sigmas()} {
    Random random{{11}};
    graph_.add_keyframe({});
    graph_.add(PosePrior{0, {}, Eigen::Matrix3d::Identity() * 1e4});
    const std::vector<Se2> markers{{2.0, 1.0, -1.5}, {4.0, -1.0, 1.6}};
    Se2 truth;
    for (const Se2& marker : markers)
      graph_.add_landmark({marker.x() + 0.02, marker.y() - 0.01, marker.theta() + 0.01});
    for (std::size_t k = 1; k <= 24; ++k) {
      const Se2 step{0.2, 0.001, 0.01};
      truth = truth * step;
      const Se2 measured{0.2 + 0.001 * random.normal(), 0.001, 0.01 + 0.002 * random.normal()};
      graph_.add_keyframe(graph_.state().keyframes.back() * measured);
      graph_.add(OdometryFactor{k - 1, k, {measured, 0.2, 0.01, 0.0, 0.2}});
      for (std::size_t m = 0; m < markers.size(); ++m) {
        MarkerFactor seen;
        seen.keyframe = k;
        seen.landmark = m;
        seen.measurement = some_measurement();
        seen.measurement.base_from_marker = truth.inverse() * markers[m];
        seen.root_information = root_of(seen.measurement.covariance.inverse());
        graph_.add(seen);
      }
      graph_.optimise();
      while (graph_.num_active_keyframes() > window)
        graph_.marginalise_oldest(1e9);
    }
    graph_.optimise();
  }

  static Calibration sigmas() {
    Calibration sigmas;
    sigmas << 0.02, 0.01, 0.02, 0.05, 0.01, 0.0087, 0.002, 0.003;
    return sigmas;
  }

  Graph& graph() { return graph_; }

  Variable newest() const { return {VariableKind::kKeyframe, graph_.state().keyframes.size() - 1}; }

 private:
  Graph graph_;
};

TEST(Graph, TheWindowsEstimateIsCloseToThatOfTheWholeGraph) {
  Drive whole{100};
  Drive window{6};
  const Eigen::Vector3d apart = pose_difference(window.graph().state().keyframes.back(),
                                                whole.graph().state().keyframes.back());
  const Eigen::Matrix3d covariance = whole.graph().covariance_of(whole.newest());
  // Linearised once and not again: off by a small part of a standard deviation.
  EXPECT_LT(apart.dot(covariance.inverse() * apart), 0.05);
  const Eigen::Matrix3d windowed = window.graph().covariance_of(window.newest());
  EXPECT_LT((windowed - covariance).norm(), 0.05 * covariance.norm());
}

TEST(Graph, StepAllRebuildsTheWindowsPrior) {
  Drive window{6};
  Drive whole{100};
  const Se2 before = window.graph().state().keyframes.back();
  window.graph().optimise_all(20);
  window.graph().optimise();
  EXPECT_LT(pose_difference(window.graph().state().keyframes.back(), before).norm(), 2e-3);
  const Eigen::Matrix3d rebuilt = window.graph().covariance_of(window.newest());
  const Eigen::Matrix3d expected = whole.graph().covariance_of(whole.newest());
  EXPECT_LT((rebuilt - expected).norm(), 0.01 * expected.norm());
}

TEST(Graph, StepAllSolvesAGraphThatIsAllWindow) {
  Drive drive{100};
  Graph& graph = drive.graph();
  graph.add(PosePrior{
      graph.state().keyframes.size() - 1, {5.0, 0.0, 0.0}, 1e6 * Eigen::Matrix3d::Identity()});
  graph.step_all();
  EXPECT_NEAR(graph.state().keyframes.back().x(), 5.0, 0.01);
}

/// The information measured about the calibration fades, that of its description stays.
TEST(Graph, InformationAboutTheCalibrationFadesWithoutMovingPoses) {
  constexpr double kDriven_m = 20.0;
  Drive drive{6};
  Graph& graph = drive.graph();
  const Se2 pose = graph.state().keyframes.back();
  const Eigen::Matrix3d of_pose = graph.covariance_of(drive.newest());
  const Eigen::MatrixXd before = graph.covariance({}, {});
  graph.add_calibration_random_walk(kDriven_m);
  graph.optimise();
  const Eigen::MatrixXd after = graph.covariance({}, {});
  for (Eigen::Index i = 0; i < kOdometryTerms; ++i) {
    const double described = Drive::sigmas()[i] * Drive::sigmas()[i];
    EXPECT_GT(after(i, i), before(i, i)) << i;
    EXPECT_LT(after(i, i), before(i, i) + 1.01 * kDriven_m / 1000.0 * described) << i;
  }
  EXPECT_LT(pose_difference(graph.state().keyframes.back(), pose).norm(), 1e-3);
  EXPECT_LT((graph.covariance_of(drive.newest()) - of_pose).norm(), 0.05 * of_pose.norm());
}

TEST(Graph, CovariancesAreSymmetricAndPositive) {
  Drive drive{6};
  const Eigen::Matrix3d covariance = drive.graph().covariance_of(drive.newest());
  EXPECT_LT((covariance - covariance.transpose()).norm(), 1e-9 * covariance.norm());
  EXPECT_GT(Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>{covariance}.eigenvalues()[0], 0.0);
}

TEST(Graph, RelativeToAKnownKeyframeTheCovarianceIsThatOfThePose) {
  Drive drive{100};  // its first pose defines the map
  const Eigen::Matrix3d covariance = drive.graph().covariance_of(drive.newest());
  EXPECT_LT((drive.graph().covariance_since(0) - covariance).norm(), 0.01 * covariance.norm());
}

TEST(Graph, TheCovarianceOfTheNewestStepIsThatSinceThePreviousKeyframe) {
  Drive drive{6};
  const Eigen::Matrix3d since = drive.graph().covariance_since(drive.newest().index - 1);
  EXPECT_LT((drive.graph().covariance_of_newest_step() - since).norm(), 1e-6 * since.norm());
}

TEST(Graph, CovarianceSinceAKeyframeGrowsWithTheDistance) {
  Drive drive{100};
  const std::size_t newest = drive.newest().index;
  EXPECT_LT(drive.graph().covariance_since(newest).norm(), 1e-12);
  for (std::size_t k = newest; k > 0; --k) {
    EXPECT_GT(drive.graph().covariance_since(k - 1).trace(),
              drive.graph().covariance_since(k).trace())
        << k;
  }
}

TEST(Graph, ARemovedKeyframeMovesWithItsAnchorAndHasNoFactors) {
  Drive drive{6};
  Graph& graph = drive.graph();
  const std::size_t num_factors = graph.factors().size();
  const Se2 before = graph.state().keyframes[1].inverse() * graph.state().keyframes[3];
  graph.remove_keyframes({{2, 1}, {3, 1}});
  EXPECT_TRUE(graph.is_removed(2));
  EXPECT_TRUE(graph.is_removed(3));
  EXPECT_FALSE(graph.is_removed(1));
  EXPECT_FALSE(graph.is_removed(4));
  for (const Factor& factor : graph.factors()) {
    if (const auto* marker = std::get_if<MarkerFactor>(&factor)) {
      EXPECT_FALSE(graph.is_removed(marker->keyframe));
    } else if (const auto* odometry = std::get_if<OdometryFactor>(&factor)) {
      EXPECT_FALSE(graph.is_removed(odometry->from) || graph.is_removed(odometry->to));
      EXPECT_EQ(odometry->is_disabled, odometry->from == 1);
      EXPECT_EQ(odometry->to, odometry->is_disabled ? 4U : odometry->from + 1);
    }
  }
  EXPECT_LT(graph.factors().size(), num_factors);
  const Eigen::Matrix3d knew = graph.covariance_of(drive.newest());
  graph.optimise_all(20);
  const Se2 after = graph.state().keyframes[1].inverse() * graph.state().keyframes[3];
  EXPECT_LT(pose_difference(after, before).norm(), 1e-9);
  EXPECT_GT(graph.covariance_of(drive.newest()).trace(), knew.trace());
}

TEST(Graph, AScanFactorKeepsItsReferencesToKeyframesThatStay) {
  Drive drive{2};
  Graph& graph = drive.graph();
  ScanFactor scan;
  scan.keyframe = 5;
  scan.references = {{1, 0.25, {}}, {2, 0.5, {}}, {3, 0.25, {}}};
  graph.add(scan);
  scan.references = {{2, 1.0, {}}};
  graph.add(scan);
  graph.remove_keyframes({{2, 1}});
  int scans = 0;
  for (const Factor& factor : graph.factors()) {
    const auto* left = std::get_if<ScanFactor>(&factor);
    if (left == nullptr) continue;
    ++scans;
    ASSERT_EQ(left->references.size(), 2U);
    EXPECT_EQ(left->references[0].keyframe, 1U);
    EXPECT_EQ(left->references[1].keyframe, 3U);
    EXPECT_DOUBLE_EQ(left->references[0].share + left->references[1].share, 1.0);
  }
  EXPECT_EQ(scans, 1);
}

}  // namespace
}  // namespace waymark
