// SPDX-License-Identifier: BSD-3-Clause
// Graph::optimise_all(): sparse Gauss-Newton over every variable.
#include "slam/core/graph/graph.hpp"

#include <Eigen/SparseCholesky>

#include <algorithm>

namespace waymark {
namespace {

using SparseMatrix = Eigen::SparseMatrix<double>;
using Triplet = Eigen::Triplet<double>;
using Solver = Eigen::SimplicialLDLT<SparseMatrix, Eigen::Lower>;

constexpr double kConverged = 1e-3;  // [m, rad]

/// Places of variables in a vector of unknowns: keyframes, landmarks, calibration.
struct WholeLayout {
  std::size_t keyframes{0};
  std::size_t landmarks{0};

  Eigen::Index offset(const Variable& variable) const {
    switch (variable.kind) {
      case VariableKind::kKeyframe:
        return 3 * static_cast<Eigen::Index>(variable.index);
      case VariableKind::kLandmark:
        return 3 * static_cast<Eigen::Index>(keyframes + variable.index);
      case VariableKind::kCalibration:
        break;
    }
    return 3 * static_cast<Eigen::Index>(keyframes + landmarks);
  }

  Eigen::Index size() const { return offset({}) + kCalibrationSize; }
};

struct SparseEquations {
  std::vector<Triplet> triplets{};  ///< lower triangle
  Eigen::VectorXd g;

  void add(const LinearFactor& linear, const WholeLayout& layout) {
    for (const LinearFactor::Block& row : linear.blocks) {
      const Eigen::Index at = layout.offset(row.variable);
      g.segment(at, row.variable.size()).noalias() += row.jacobian.transpose() * linear.residual;
      for (const LinearFactor::Block& column : linear.blocks) {
        const Eigen::Index beside = layout.offset(column.variable);
        if (beside > at) continue;
        const Eigen::MatrixXd product = row.jacobian.transpose() * column.jacobian;
        for (Eigen::Index i = 0; i < product.rows(); ++i)
          for (Eigen::Index k = 0; k < product.cols(); ++k)
            if (beside + k <= at + i) triplets.emplace_back(at + i, beside + k, product(i, k));
      }
    }
  }

  SparseMatrix matrix() const {
    SparseMatrix result{g.size(), g.size()};
    result.setFromTriplets(triplets.begin(), triplets.end());
    return result;
  }
};

}  // namespace

void Graph::optimise_all(int iterations, const std::vector<std::size_t>& activated) {
  const WholeLayout whole{state_.keyframes.size(), state_.landmarks.size()};
  const Eigen::Index calibration_at = whole.offset({});
  const auto with_calibration = [&](SparseEquations& equations) {
    Eigen::MatrixXd h = Eigen::MatrixXd::Zero(kCalibrationSize, kCalibrationSize);
    Eigen::VectorXd g = Eigen::VectorXd::Zero(kCalibrationSize);
    calibration_.add_to(state_.calibration, h, g);
    equations.g.tail<kCalibrationSize>() += g;
    for (Eigen::Index i = 0; i < kCalibrationSize; ++i)
      for (Eigen::Index k = 0; k <= i; ++k)
        equations.triplets.emplace_back(calibration_at + i, calibration_at + k, h(i, k));
  };
  // Landmarks that do not move keep the equations regular.
  const auto with_fixed = [&](SparseEquations& equations) {
    for (std::size_t k = 0; k < whole.landmarks; ++k) {
      if (!is_fixed_[k]) continue;
      const Eigen::Index at = whole.offset({VariableKind::kLandmark, k});
      for (Eigen::Index i = 0; i < 3; ++i)
        equations.triplets.emplace_back(at + i, at + i, 1.0);
    }
  };
  for (int i = 0; i < iterations; ++i) {
    SparseEquations equations;
    equations.g = Eigen::VectorXd::Zero(whole.size());
    with_calibration(equations);
    with_fixed(equations);
    for (const Factor& factor : factors_)
      equations.add(linearised(factor), whole);
    const Solver solver{equations.matrix()};
    const Eigen::VectorXd step = solver.solve(-equations.g);
    if (solver.info() != Eigen::Success || !step.allFinite()) break;
    for (std::size_t k = 0; k < whole.keyframes; ++k) {
      const Variable variable{VariableKind::kKeyframe, k};
      state_.retract(variable, step.segment(whole.offset(variable), 3));
    }
    for (std::size_t k = 0; k < whole.landmarks; ++k) {
      const Variable variable{VariableKind::kLandmark, k};
      state_.retract(variable, step.segment(whole.offset(variable), 3));
    }
    state_.retract({}, step.tail<kCalibrationSize>());
    for (Factor& factor : factors_)
      if (auto* scan = std::get_if<ScanFactor>(&factor); scan != nullptr && scan->is_loop)
        scan->reweigh(state_);
    if (step.cwiseAbs().maxCoeff() < kConverged) break;
  }

  // The window's prior: all factors that touch what lies behind it, with that eliminated.
  for (const std::size_t landmark : activated) {
    const Variable variable{VariableKind::kLandmark, landmark};
    if (!is_active(variable)) push_variable(variable);
  }
  std::vector<bool> is_active_factor(factors_.size(), false);
  for (const std::size_t index : active_factors_)
    is_active_factor[index] = true;
  SparseEquations behind;
  behind.g = Eigen::VectorXd::Zero(whole.size());
  with_fixed(behind);
  for (std::size_t index = 0; index < factors_.size(); ++index)
    if (!is_active_factor[index]) behind.add(linearised(factors_[index]), whole);

  // Unknowns are split into those behind the window and those in it.
  std::vector<Eigen::Index> place(static_cast<std::size_t>(whole.size()), -1);  // < 0: behind
  for (const Variable& variable : layout_) {
    for (Eigen::Index i = 0; i < variable.size(); ++i)
      place[static_cast<std::size_t>(whole.offset(variable) + i)] = offsets_.at(variable) + i;
  }
  std::vector<Eigen::Index> order(place.size());
  Eigen::Index num_behind = 0;
  for (std::size_t i = 0; i < place.size(); ++i)
    order[i] = place[i] < 0 ? num_behind++ : place[i];
  const Eigen::Index window_size = prior_.g.size();
  std::vector<Triplet> own;
  Eigen::MatrixXd between = Eigen::MatrixXd::Zero(num_behind, window_size);
  prior_.h.setZero();
  for (const Triplet& entry : behind.triplets) {
    const auto row = static_cast<std::size_t>(entry.row());
    const auto column = static_cast<std::size_t>(entry.col());
    if (place[row] < 0 && place[column] < 0) {
      own.emplace_back(std::max(order[row], order[column]), std::min(order[row], order[column]),
                       entry.value());
    } else if (place[row] < 0) {
      between(order[row], order[column]) += entry.value();
    } else if (place[column] < 0) {
      between(order[column], order[row]) += entry.value();
    } else {
      prior_.h(std::max(order[row], order[column]), std::min(order[row], order[column])) +=
          entry.value();
    }
  }
  prior_.h = Eigen::MatrixXd{prior_.h.selfadjointView<Eigen::Lower>()};
  Eigen::VectorXd g_behind(num_behind);
  for (std::size_t i = 0; i < place.size(); ++i)
    (place[i] < 0 ? g_behind : prior_.g)[order[i]] = behind.g[static_cast<Eigen::Index>(i)];
  if (num_behind == 0) return;
  SparseMatrix own_matrix{num_behind, num_behind};
  own_matrix.setFromTriplets(own.begin(), own.end());
  const Solver solver{own_matrix};
  std::vector<Eigen::Index> linked;
  for (Eigen::Index i = 0; i < window_size; ++i)
    if (between.col(i).cwiseAbs().maxCoeff() > 0.0) linked.push_back(i);
  Eigen::MatrixXd columns(num_behind, static_cast<Eigen::Index>(linked.size()));
  for (std::size_t i = 0; i < linked.size(); ++i)
    columns.col(static_cast<Eigen::Index>(i)) = between.col(linked[i]);
  const Eigen::MatrixXd gain = solver.solve(columns);
  const Eigen::MatrixXd lost = columns.transpose() * gain;
  const Eigen::VectorXd pull = gain.transpose() * g_behind;
  for (std::size_t i = 0; i < linked.size(); ++i) {
    prior_.g[linked[i]] -= pull[static_cast<Eigen::Index>(i)];
    for (std::size_t k = 0; k < linked.size(); ++k)
      prior_.h(linked[i], linked[k]) -=
          lost(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(k));
  }
}

}  // namespace waymark
