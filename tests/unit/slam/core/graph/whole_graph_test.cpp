// SPDX-License-Identifier: BSD-3-Clause
// The whole graph with loops that contradict it.
#include "common/random/random.hpp"
#include "slam/core/graph/graph.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>

namespace waymark {
namespace {

constexpr double kSpacing_m = 0.2;

/// Keyframes on a straight line.
class Line {
 public:
  Line(std::size_t length, const GraphNoise& noise) : graph_{noise, Calibration::Constant(0.01)} {
    graph_.add_keyframe({});
    graph_.add(PosePrior{0, {}, Eigen::Matrix3d::Identity() * 1e4});
    for (std::size_t k = 1; k <= length; ++k) {
      graph_.add_keyframe(Se2{kSpacing_m * static_cast<double>(k), 0.0, 0.0});
      graph_.add(OdometryFactor{k - 1, k, Motion::between({}, {kSpacing_m, 0.0, 0.0})});
      if (graph_.num_active_keyframes() > kWindow) graph_.marginalise_oldest(0.0);
    }
  }

  void close(std::size_t from, std::size_t to, const Se2& from_from_to) {
    ScanFactor factor;
    factor.keyframe = to;
    factor.references = {{from, 1.0, from_from_to}};
    factor.root_information = root_of(Eigen::Vector3d{1e4, 1e4, 1e5}.asDiagonal());
    factor.is_loop = true;
    graph_.add(factor);
  }

  Graph& graph() { return graph_; }

 private:
  static constexpr std::size_t kWindow = 48;

  Graph graph_;
};

GraphNoise rolling_only() {
  GraphNoise noise;
  noise.odometry.may_slip = false;  // no slip explains a wrong loop
  return noise;
}

TEST(WholeGraph, AWrongLoopAmongCorrectOnesLosesItsWeight) {
  Line line{40, rolling_only()};
  for (const std::size_t k : {30U, 32U, 34U, 36U, 38U, 40U})
    line.close(2, k, {kSpacing_m * static_cast<double>(k - 2), 0.0, 0.0});
  line.close(3, 35, {kSpacing_m * 32.0, 1.5, 0.0});
  line.graph().optimise_all(20);
  EXPECT_NEAR(line.graph().state().keyframes[35].y(), 0.0, 0.05);
  for (const Factor& factor : line.graph().factors()) {
    const auto* scan = std::get_if<ScanFactor>(&factor);
    if (scan != nullptr) {
      EXPECT_EQ(scan->weight < 0.5, scan->keyframe == 35) << scan->keyframe << ": " << scan->weight;
    }
  }
}

/// Far from the optimum the linearisation is invalid: unless a step that raises the cost is
/// shortened, keyframes leave the building.
TEST(WholeGraph, NoStepRaisesTheCostHoweverWrongTheLoopsAre) {
  constexpr std::size_t kLength = 300;
  constexpr int kLoops = 12;
  constexpr double kReweighed = 25.0 * kLoops;  // the weights of the loops follow the step
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    Random random{{seed}};
    GraphNoise noise = seed % 2 == 0 ? GraphNoise{} : rolling_only();
    noise.learnt_odometry = {8.0, 8.0};
    Line line{kLength, noise};
    for (int i = 0; i < kLoops; ++i) {
      const auto from = static_cast<std::size_t>(random.uniform(0.0, 150.0));
      const auto to = static_cast<std::size_t>(random.uniform(160.0, 300.0));
      line.close(from, to,
                 {random.uniform(-3.0, 3.0), random.uniform(-3.0, 3.0), random.uniform(-3.1, 3.1)});
    }
    for (int step = 0; step < 12; ++step) {
      const double before = line.graph().cost();
      line.graph().step_all();
      EXPECT_LT(line.graph().cost(), before + kReweighed) << seed << ", step " << step;
    }
  }
}

/// No keyframe has measured the landmarks, so the equations are singular.
TEST(WholeGraph, WithoutASolutionItHasNotConvergedAndNothingChanges) {
  Line line{60, rolling_only()};
  Graph& graph = line.graph();
  const std::size_t unmeasured = graph.add_landmark({1e3, 0.0, 0.0});
  const std::size_t returning = graph.add_landmark({1e3, 5.0, 0.0});
  graph.marginalise_oldest(10.0);
  line.close(0, 60, {1.5, 0.0, 0.0});
  const double x_m = graph.state().keyframes[5].x();
  ASSERT_FALSE(graph.is_active({VariableKind::kLandmark, unmeasured}));
  EXPECT_TRUE(std::isinf(graph.step_all({returning})));
  EXPECT_EQ(graph.state().keyframes[5].x(), x_m);
  graph.optimise();
  EXPECT_TRUE(std::isfinite(graph.state().keyframes.back().x()));
  EXPECT_GT(graph.covariance_of({VariableKind::kKeyframe, 60}).trace(), 0.0);
}

}  // namespace
}  // namespace waymark
