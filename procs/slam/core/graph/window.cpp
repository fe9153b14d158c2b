// SPDX-License-Identifier: BSD-3-Clause
// The newest keyframes, solved by Gauss-Newton.
#include "slam/core/graph/graph.hpp"
#include "slam/core/graph/step_share.hpp"

#include <algorithm>
#include <limits>

namespace waymark {
namespace {

constexpr int kMaxIterations = 5;
constexpr double kConverged = 1e-4;         // [m, rad]; the remaining error is about its square
constexpr std::size_t kWithCovariance = 2;  // keyframes, the newest ones
constexpr int kMaxSlips = 3;                // found by one optimise()

}  // namespace

void Graph::add_to(NormalEquations& equations, const LinearFactor& linear) const {
  std::vector<Eigen::Index> offsets;
  offsets.reserve(linear.blocks.size());
  for (const LinearFactor::Block& block : linear.blocks)
    offsets.push_back(offsets_.at(block.variable));
  for (std::size_t i = 0; i < offsets.size(); ++i) {
    const LinearFactor::Block& row = linear.blocks[i];
    equations.g.segment(offsets[i], row.variable.size()).noalias() +=
        row.jacobian.transpose() * linear.residual;
    for (std::size_t k = 0; k < offsets.size(); ++k) {
      const LinearFactor::Block& column = linear.blocks[k];
      if (offsets[k] > offsets[i]) continue;
      equations.h.block(offsets[i], offsets[k], row.variable.size(), column.variable.size())
          .noalias() += row.jacobian.transpose() * column.jacobian;
    }
  }
}

Graph::NormalEquations Graph::window_equations() const {
  NormalEquations equations = prior_;
  const Eigen::Index at = offsets_.at({VariableKind::kCalibration, 0});
  calibration_.add_to(state_.calibration,
                      equations.h.block<kCalibrationSize, kCalibrationSize>(at, at),
                      equations.g.segment<kCalibrationSize>(at));
  for (const std::size_t index : active_factors_)
    add_to(equations, linearised(factors_[index]));
  return equations;
}

void Graph::retract_window(const Eigen::VectorXd& step) {
  for (const Variable& variable : layout_)
    state_.retract(variable, step.segment(offsets_.at(variable), variable.size()));
  prior_.g += prior_.h.selfadjointView<Eigen::Lower>() * step;
}

/// Computed for all variables but the older keyframes, which come first in the layout: the lower
/// right corner of (L L')^-1 needs only that corner of L.
void Graph::update_covariance() {
  const std::size_t count = state_.keyframes.size();
  const Eigen::Index first =
      count == 0
          ? 0
          : offsets_.at({VariableKind::kKeyframe,
                         std::max(first_keyframe_, count - std::min(count, kWithCovariance))});
  const Eigen::Index size = root_.rows() - first;
  covariance_offsets_.clear();
  for (const auto& [variable, offset] : offsets_)
    if (offset >= first) covariance_offsets_[variable] = offset - first;
  Eigen::MatrixXd half = Eigen::MatrixXd::Identity(size, size);
  root_.matrixLLT().bottomRightCorner(size, size).triangularView<Eigen::Lower>().solveInPlace(half);
  covariance_.noalias() = half.transpose() * half;
  for (const auto& [variable, offset] : covariance_offsets_) {
    if (variable.kind == VariableKind::kCalibration) continue;
    const Eigen::Matrix2d to_map = state_.pose(variable).rotation();
    covariance_.middleRows<2>(offset) = (to_map * covariance_.middleRows<2>(offset)).eval();
    covariance_.middleCols<2>(offset) =
        (covariance_.middleCols<2>(offset) * to_map.transpose()).eval();
    if (variable.kind == VariableKind::kLandmark)
      landmark_covariances_[variable.index] = covariance_.block<3, 3>(offset, offset);
  }
}

/// One step of Gauss-Newton with the kinds of motion as they are.
Eigen::VectorXd Graph::step_window() {
  const NormalEquations equations = window_equations();
  root_.compute(equations.h);
  Eigen::VectorXd step = root_.solve(-equations.g);
  step *=
      step_share(step, layout_, [this](const Variable& variable) { return offsets_.at(variable); });
  retract_window(step);
  return step;
}

/// @return sum of the steps.
Eigen::VectorXd Graph::solve_window() {
  Eigen::VectorXd moved = Eigen::VectorXd::Zero(prior_.g.size());
  double step_size = std::numeric_limits<double>::infinity();
  for (int i = 0; i < kMaxIterations && step_size >= kConverged; ++i) {
    for (const std::size_t index : active_factors_)
      choose_kind(factors_[index]);
    const Eigen::VectorXd step = step_window();
    moved += step;
    step_size = step.cwiseAbs().maxCoeff();
  }
  update_covariance();
  const Variable calibration{};
  calibration_.choose_prior_widths(state_.calibration,
                                   covariance(calibration, calibration).diagonal());
  return moved;
}

void Graph::optimise() {
  solve_window();
  if (!has_markers()) return;
  for (int i = 0; i < kMaxSlips && assume_slip(); ++i)
    solve_window();
}

}  // namespace waymark
