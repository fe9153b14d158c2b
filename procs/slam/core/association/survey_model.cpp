// SPDX-License-Identifier: BSD-3-Clause
#include "slam/core/association/survey_model.hpp"

#include "slam/core/graph/damped_root.hpp"
#include "slam/core/graph/step_share.hpp"

#include <Eigen/LU>

#include <algorithm>
#include <cmath>

namespace waymark {
namespace {

constexpr int kMaxSteps = 20;
constexpr double kConverged = 1e-5;  // [m, rad]
constexpr double kGauge = 1e3;       // 1 / sigma [1/m, 1/rad] of the prior that fixes the gauge

void retract_all(State& state, const Eigen::VectorXd& step) {
  for (std::size_t i = 0; i < state.landmarks.size(); ++i)
    state.retract({VariableKind::kLandmark, i}, step.segment(3 * static_cast<Eigen::Index>(i), 3));
}

/// Steps of all landmarks when the map moves rigidly: one column each for x, y and theta.
Eigen::MatrixXd rigid_steps(const State& state) {
  Eigen::MatrixXd steps{3 * std::ssize(state.landmarks), 3};
  for (std::size_t i = 0; i < state.landmarks.size(); ++i) {
    const Se2& place = state.landmarks[i];
    steps.middleRows<3>(3 * static_cast<Eigen::Index>(i)) =
        block_rotation(place.rotation().transpose()) * lever_arm_jacobian(place.translation());
  }
  return steps;
}

/// step_share() by the largest turn of a landmark.
double share_of(const Eigen::VectorXd& step) {
  double turn_rad = 0.0;
  for (Eigen::Index i = 2; i < step.size(); i += 3)
    turn_rad = std::max(turn_rad, std::abs(step[i]));
  return step_share(turn_rad);
}

struct Equations {
  Eigen::MatrixXd h;
  Eigen::VectorXd g;
};

Equations equations_of(const std::vector<LandmarkPrior>& priors, const State& state) {
  const Eigen::Index size = 3 * std::ssize(state.landmarks);
  Equations equations{Eigen::MatrixXd::Zero(size, size), Eigen::VectorXd::Zero(size)};
  for (const LandmarkPrior& prior : priors) {
    const auto at = 3 * static_cast<Eigen::Index>(prior.landmark);
    const LinearFactor linear = prior.linearise(state);
    const LinearFactor::Jacobian& jacobian = linear.blocks.front().jacobian;
    equations.h.block<3, 3>(at, at) += jacobian.transpose() * jacobian;
    equations.g.segment<3>(at) += jacobian.transpose() * linear.residual;
  }
  return equations;
}

/// Applies steps of `next_step` until they are small, at most kMaxSteps.
template <class NextStep>
void iterate(State& state, const NextStep& next_step) {
  for (int i = 0; i < kMaxSteps; ++i) {
    const Eigen::VectorXd step = next_step();
    retract_all(state, step);
    if (step.cwiseAbs().maxCoeff() < kConverged) break;
  }
}

}  // namespace

SurveyModel::Solution SurveyModel::solve(const std::vector<LandmarkPrior>& priors) const {
  Solution solution;
  State& state = solution.state;
  state.landmarks = marginal_.map_from_marker;
  // First all landmarks move rigidly into the survey's frame, which changes no measurement's
  // residual, unlike a large step that bends the map.
  iterate(state, [&]() -> Eigen::VectorXd {
    const Equations equations = equations_of(priors, state);
    const Eigen::MatrixXd rigid = rigid_steps(state);
    const Eigen::Matrix3d h = rigid.transpose() * equations.h * rigid;
    const Eigen::VectorXd step = rigid * h.llt().solve(-rigid.transpose() * equations.g);
    return share_of(step) * step;
  });
  Eigen::VectorXd g = marginal_.g;
  DampedRoot root;
  iterate(state, [&]() -> Eigen::VectorXd {
    const Equations equations = equations_of(priors, state);
    root.compute(marginal_.h + equations.h);
    Eigen::VectorXd step = root.solve(-(g + equations.g));
    step *= share_of(step);
    solution.cost += step.dot(2.0 * g + marginal_.h * step);
    g += marginal_.h * step;
    return step;
  });
  for (const LandmarkPrior& prior : priors)
    solution.cost += prior.linearise(state).residual.squaredNorm();
  solution.covariance = root.solve(Eigen::MatrixXd::Identity(g.size(), g.size()));
  return solution;
}

double SurveyModel::cost_without_priors() const {
  LandmarkPrior gauge;
  gauge.map_from_marker = marginal_.map_from_marker.front();
  gauge.root_information = kGauge * Eigen::Matrix3d::Identity();
  return solve({gauge}).cost;
}

double saving_without(const LandmarkPrior& prior, const SurveyModel::Solution& solution) {
  const auto at = 3 * static_cast<Eigen::Index>(prior.landmark);
  const LinearFactor linear = prior.linearise(solution.state);
  const Eigen::Matrix3d jacobian = linear.blocks.front().jacobian;
  const Eigen::Matrix3d left =
      Eigen::Matrix3d::Identity() -
      jacobian * solution.covariance.block<3, 3>(at, at) * jacobian.transpose();
  return linear.residual.dot(left.inverse() * linear.residual);
}

}  // namespace waymark
