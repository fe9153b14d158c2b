// SPDX-License-Identifier: BSD-3-Clause
// Sparse Gauss-Newton over all variables, and the marginal of some landmarks.
#include "slam/core/graph/elimination.hpp"
#include "slam/core/graph/graph.hpp"
#include "slam/core/graph/step_share.hpp"

#include <cmath>
#include <limits>

namespace waymark {
namespace {

constexpr double kConverged = 1e-3;  // [m, rad]
constexpr double kNoWorse = 1.0;     // rise of the cost that is not significant
constexpr double kMinShare = 0.1;    // of a step: it is halved down to about this, then dropped

}  // namespace

void Graph::reconsider_factors() {
  for (Factor& factor : factors_) {
    choose_kind(factor);
    if (auto* scan = std::get_if<ScanFactor>(&factor); scan != nullptr && scan->is_loop)
      scan->reweigh(state_);
  }
}

void Graph::optimise_all(int steps) {
  for (int i = 0; i < steps; ++i) {
    const double moved = step_all();
    if (moved < kConverged || !std::isfinite(moved)) break;
  }
}

std::vector<Variable> Graph::variables_outside_window() const {
  std::vector<Variable> variables;
  for (std::size_t i = 0; i < first_keyframe_; ++i)
    if (!is_removed(i)) variables.push_back({VariableKind::kKeyframe, i});
  for (std::size_t i = 0; i < state_.landmarks.size(); ++i)
    if (const Variable landmark{VariableKind::kLandmark, i}; !is_fixed_[i] && !is_active(landmark))
      variables.push_back(landmark);
  return variables;
}

std::vector<LinearFactor> Graph::factors_outside_window() const {
  std::vector<bool> is_active_factor(factors_.size(), false);
  for (const std::size_t index : active_factors_)
    is_active_factor[index] = true;
  std::vector<LinearFactor> outside;
  outside.reserve(factors_.size());
  for (std::size_t index = 0; index < factors_.size(); ++index)
    if (!is_active_factor[index]) outside.push_back(linearised(factors_[index]));
  return outside;
}

double Graph::step_all(const std::vector<std::size_t>& activated) {
  std::vector<Variable> inserted;
  for (const std::size_t landmark : activated) {
    const Variable variable{VariableKind::kLandmark, landmark};
    if (is_active(variable)) continue;
    insert_variable(variable);
    inserted.push_back(variable);
  }
  const std::vector<Variable> variables = variables_outside_window();
  const Eigen::Index num_window = prior_.g.size();
  if (variables.empty()) {
    const double moved = solve_window().cwiseAbs().maxCoeff();
    reconsider_factors();
    return moved;
  }

  const double cost_before = cost();
  const Elimination elimination{variables, factors_outside_window(), num_window,
                                [this](const Variable& variable) {
                                  return offsets_.at(variable);
                                }};
  if (!elimination.has_solution()) {
    for (const Variable& variable : inserted)
      remove_from_layout(variable);  // no factor of the window refers to it
    return std::numeric_limits<double>::infinity();
  }

  prior_.h = elimination.corner_h();
  prior_.g = elimination.corner_g();

  const State before = state_;
  const Eigen::VectorXd window_g = prior_.g;
  const Eigen::VectorXd window_step = solve_window();
  Eigen::VectorXd x = elimination.step(window_step);
  const auto place_of = [&](const Variable& variable) {
    return elimination.place_of(variable);
  };
  x *= step_share(x, variables, place_of);
  const auto retract_outside = [&](double share) {
    for (const Variable& variable : variables)
      state_.retract(variable, share * x.segment(place_of(variable), 3));
  };
  retract_outside(1.0);
  double share = 1.0;
  while (cost() > cost_before + kNoWorse) {
    share = share > kMinShare ? 0.5 * share : 0.0;
    state_ = before;
    prior_.g = window_g;
    retract_window(share * window_step);
    retract_outside(share);
    if (share == 0.0) break;
  }
  move_removed();
  reconsider_factors();
  return share * x.cwiseAbs().maxCoeff();
}

std::optional<LandmarkMarginal> Graph::marginal_of(
    const std::vector<std::size_t>& landmarks) const {
  std::vector<Eigen::Index> place(state_.landmarks.size(), -1);  // after the calibration
  for (std::size_t i = 0; i < landmarks.size(); ++i)
    place[landmarks[i]] = kCalibrationSize + 3 * static_cast<Eigen::Index>(i);
  std::vector<Variable> eliminated;
  for (std::size_t i = 0; i < state_.keyframes.size(); ++i)
    if (!is_removed(i)) eliminated.push_back({VariableKind::kKeyframe, i});
  for (std::size_t i = 0; i < state_.landmarks.size(); ++i)
    if (place[i] < 0 && !is_fixed_[i]) eliminated.push_back({VariableKind::kLandmark, i});
  std::vector<LinearFactor> linear;
  linear.reserve(factors_.size());
  for (const Factor& factor : factors_)
    if (!std::holds_alternative<LandmarkPrior>(factor)) linear.push_back(linearised(factor));
  const Eigen::Index num_kept = 3 * std::ssize(landmarks);
  const Elimination elimination{
      eliminated, linear, kCalibrationSize + num_kept, [&](const Variable& variable) {
        return variable.kind == VariableKind::kCalibration ? 0 : place[variable.index];
      }};
  if (!elimination.has_solution()) return std::nullopt;

  Eigen::MatrixXd h = elimination.corner_h();
  Eigen::VectorXd g = elimination.corner_g();
  calibration_.add_to(state_.calibration, h.topLeftCorner<kCalibrationSize, kCalibrationSize>(),
                      g.head<kCalibrationSize>());
  const auto root = h.topLeftCorner<kCalibrationSize, kCalibrationSize>().llt();
  const Eigen::MatrixXd column = h.bottomLeftCorner(num_kept, kCalibrationSize);
  const Eigen::MatrixXd gain = root.solve(column.transpose()).transpose();
  LandmarkMarginal marginal;
  for (const std::size_t landmark : landmarks)
    marginal.map_from_marker.push_back(state_.landmarks[landmark]);
  marginal.h = h.bottomRightCorner(num_kept, num_kept) - gain * column.transpose();
  marginal.g = g.tail(num_kept) - gain * g.head<kCalibrationSize>();
  return marginal;
}

}  // namespace waymark
