// SPDX-License-Identifier: BSD-3-Clause
// Graph::step_all(): sparse Gauss-Newton over every variable.
#include "slam/core/graph/graph.hpp"
#include "slam/core/graph/step_share.hpp"

#include <Eigen/OrderingMethods>
#include <Eigen/SparseCholesky>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace waymark {
namespace {

using SparseMatrix = Eigen::SparseMatrix<double>;
using Triplet = Eigen::Triplet<double>;
using Solver = Eigen::SimplicialLDLT<SparseMatrix, Eigen::Upper, Eigen::NaturalOrdering<int>>;

constexpr double kConverged = 1e-3;  // [m, rad]
constexpr double kNoWorse = 1.0;     // by which a step may raise the cost: not significant
constexpr double kLeastShare = 0.1;  // of a step that lowers the cost; else none is taken

/// Places of the unknowns: those behind the window in an order that keeps the factorisation sparse,
/// after them the window's as they are.
class EliminationOrder {
 public:
  explicit EliminationOrder(const std::vector<Variable>& variables) {
    for (const Variable& variable : variables) {
      std::vector<Eigen::Index>& numbers = numbers_[static_cast<std::size_t>(variable.kind)];
      if (numbers.size() <= variable.index) numbers.resize(variable.index + 1, -1);
      numbers[variable.index] = std::ssize(place_);
      place_.push_back(std::ssize(place_));
    }
  }

  Eigen::Index size() const { return 3 * std::ssize(place_); }

  /// Less than 0: in the window.
  Eigen::Index number_of(const Variable& variable) const {
    const std::vector<Eigen::Index>& numbers = numbers_[static_cast<std::size_t>(variable.kind)];
    return variable.index < numbers.size() ? numbers[variable.index] : -1;
  }

  Eigen::Index place_of_number(Eigen::Index number) const {
    return 3 * place_[static_cast<std::size_t>(number)];
  }

  /// Approximate minimum degree over blocks of three.
  void order(const std::vector<LinearFactor>& factors) {
    std::vector<Triplet> neighbours;
    for (const LinearFactor& factor : factors) {
      for (const LinearFactor::Block& row : factor.blocks) {
        const Eigen::Index i = number_of(row.variable);
        for (const LinearFactor::Block& column : factor.blocks) {
          const Eigen::Index k = number_of(column.variable);
          if (k >= 0 && i > k) neighbours.emplace_back(i, k, 1.0);
        }
      }
    }
    const Eigen::Index count = std::ssize(place_);
    for (Eigen::Index i = 0; i < count; ++i)
      neighbours.emplace_back(i, i, 1.0);
    SparseMatrix pattern{count, count};
    pattern.setFromTriplets(neighbours.begin(), neighbours.end());
    Eigen::PermutationMatrix<Eigen::Dynamic, Eigen::Dynamic, int> pivots;
    Eigen::AMDOrdering<int>{}(pattern.selfadjointView<Eigen::Lower>(), pivots);
    for (Eigen::Index i = 0; i < count; ++i)
      place_[static_cast<std::size_t>(pivots.indices()[i])] = i;
  }

 private:
  std::array<std::vector<Eigen::Index>, 3> numbers_{};  ///< by VariableKind and index; -1: none
  std::vector<Eigen::Index> place_{};  ///< in the elimination, by number; in blocks of three
};

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

double Graph::step_all(const std::vector<std::size_t>& activated) {
  std::vector<Variable> inserted;
  for (const std::size_t landmark : activated) {
    const Variable variable{VariableKind::kLandmark, landmark};
    if (is_active(variable)) continue;
    insert_variable(variable);
    inserted.push_back(variable);
  }
  std::vector<Variable> variables;
  for (std::size_t i = 0; i < first_keyframe_; ++i)
    if (!is_removed(i)) variables.push_back({VariableKind::kKeyframe, i});
  for (std::size_t i = 0; i < state_.landmarks.size(); ++i)
    if (const Variable landmark{VariableKind::kLandmark, i}; !is_fixed_[i] && !is_active(landmark))
      variables.push_back(landmark);
  EliminationOrder order{variables};
  const Eigen::Index num_behind = order.size();
  const Eigen::Index num_window = prior_.g.size();
  if (num_behind == 0) {
    const double moved = solve_window().cwiseAbs().maxCoeff();
    reconsider_factors();
    return moved;
  }

  const double cost_before = cost();
  std::vector<bool> is_active_factor(factors_.size(), false);
  for (const std::size_t index : active_factors_)
    is_active_factor[index] = true;
  std::vector<LinearFactor> behind;
  behind.reserve(factors_.size());
  for (std::size_t index = 0; index < factors_.size(); ++index)
    if (!is_active_factor[index]) behind.push_back(linearised(factors_[index]));
  order.order(behind);
  const auto place_of = [&](const Variable& variable) {
    const Eigen::Index number = order.number_of(variable);
    return number >= 0 ? order.place_of_number(number) : num_behind + offsets_.at(variable);
  };

  Eigen::VectorXd g = Eigen::VectorXd::Zero(num_behind + num_window);
  std::vector<Triplet> triplets;  // upper triangle
  triplets.reserve(64 * behind.size());
  // One on the window's diagonal keeps pivots from zero, and is subtracted again.
  for (Eigen::Index i = 0; i < num_window; ++i)
    triplets.emplace_back(num_behind + i, num_behind + i, 1.0);
  for (const LinearFactor& factor : behind) {
    for (const LinearFactor::Block& column : factor.blocks) {
      const Eigen::Index at = place_of(column.variable);
      g.segment(at, column.variable.size()).noalias() +=
          column.jacobian.transpose() * factor.residual;
      for (const LinearFactor::Block& row : factor.blocks) {
        const Eigen::Index above = place_of(row.variable);
        if (above > at) continue;
        const LinearFactor::Product product = row.jacobian.transpose() * column.jacobian;
        for (Eigen::Index k = 0; k < product.cols(); ++k)
          for (Eigen::Index i = 0; i < product.rows() && above + i <= at + k; ++i)
            triplets.emplace_back(above + i, at + k, product(i, k));
      }
    }
  }
  SparseMatrix h{num_behind + num_window, num_behind + num_window};
  h.setFromTriplets(triplets.begin(), triplets.end());
  const Solver solver{h};
  if (solver.info() != Eigen::Success || !solver.vectorD().allFinite()) {
    for (const Variable& variable : inserted)
      remove_from_layout(variable);  // the window has no measurement of it
    return std::numeric_limits<double>::infinity();
  }

  // H = L D L': the lower right corner is the Schur complement's.
  const auto& l = solver.matrixL().nestedExpression();
  Eigen::MatrixXd corner = Eigen::MatrixXd::Identity(num_window, num_window);
  for (Eigen::Index k = 0; k < num_window; ++k)
    for (SparseMatrix::InnerIterator entry{l, num_behind + k}; entry; ++entry)
      if (entry.row() > entry.col()) corner(entry.row() - num_behind, k) = entry.value();
  Eigen::VectorXd x = g;
  solver.matrixL().solveInPlace(x);
  prior_.h.noalias() = corner * solver.vectorD().tail(num_window).asDiagonal() * corner.transpose();
  prior_.h.diagonal().array() -= 1.0;
  prior_.g.noalias() = corner * x.tail(num_window);

  const State before = state_;
  const Eigen::VectorXd window_g = prior_.g;
  const Eigen::VectorXd window_step = solve_window();
  x.head(num_behind) = -x.head(num_behind).cwiseQuotient(solver.vectorD().head(num_behind));
  x.tail(num_window).noalias() = corner.transpose() * window_step;
  solver.matrixU().solveInPlace(x);
  x.head(num_behind) *= step_share(x, variables, place_of);
  const auto retract_behind = [&](double share) {
    for (const Variable& variable : variables)
      state_.retract(variable, share * x.segment(place_of(variable), 3));
  };
  retract_behind(1.0);
  double share = 1.0;
  while (cost() > cost_before + kNoWorse) {
    share = share > kLeastShare ? 0.5 * share : 0.0;
    state_ = before;
    prior_.g = window_g;
    retract_window(share * window_step);
    retract_behind(share);
    if (share == 0.0) break;
  }
  carry_removed();
  reconsider_factors();
  return x.head(num_behind).cwiseAbs().maxCoeff();
}

}  // namespace waymark
