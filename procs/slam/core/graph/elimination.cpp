// SPDX-License-Identifier: BSD-3-Clause
#include "slam/core/graph/elimination.hpp"

#include <Eigen/OrderingMethods>

namespace waymark {

Elimination::Order::Order(const std::vector<Variable>& variables,
                          const std::vector<LinearFactor>& factors) {
  for (const Variable& variable : variables) {
    std::vector<Eigen::Index>& numbers = numbers_[static_cast<std::size_t>(variable.kind)];
    if (numbers.size() <= variable.index) numbers.resize(variable.index + 1, -1);
    numbers[variable.index] = std::ssize(place_);
    place_.push_back(std::ssize(place_));
  }
  // Approximate minimum degree over blocks of three.
  using Triplet = Eigen::Triplet<double>;
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

Eigen::Index Elimination::Order::number_of(const Variable& variable) const {
  const std::vector<Eigen::Index>& numbers = numbers_[static_cast<std::size_t>(variable.kind)];
  return variable.index < numbers.size() ? numbers[variable.index] : -1;
}

Elimination::Elimination(const std::vector<Variable>& eliminated,
                         const std::vector<LinearFactor>& factors, Eigen::Index num_kept,
                         const std::function<Eigen::Index(const Variable&)>& place_in_corner)
    : order_{eliminated, factors}, num_kept_{num_kept} {
  const Eigen::Index num_eliminated = order_.size();
  const auto place = [&](const Variable& variable) {
    return order_.has(variable) ? order_.place_of(variable)
                                : num_eliminated + place_in_corner(variable);
  };
  Eigen::VectorXd g = Eigen::VectorXd::Zero(num_eliminated + num_kept);
  std::vector<Eigen::Triplet<double>> triplets;  // upper triangle
  triplets.reserve(64 * factors.size());
  // Ones on the corner's diagonal keep pivots from zero; corner_h() subtracts them again.
  for (Eigen::Index i = 0; i < num_kept; ++i)
    triplets.emplace_back(num_eliminated + i, num_eliminated + i, 1.0);
  for (const LinearFactor& factor : factors) {
    for (const LinearFactor::Block& column : factor.blocks) {
      const Eigen::Index at = place(column.variable);
      g.segment(at, column.variable.size()).noalias() +=
          column.jacobian.transpose() * factor.residual;
      for (const LinearFactor::Block& row : factor.blocks) {
        const Eigen::Index above = place(row.variable);
        if (above > at) continue;
        const LinearFactor::Product product = row.jacobian.transpose() * column.jacobian;
        for (Eigen::Index k = 0; k < product.cols(); ++k)
          for (Eigen::Index i = 0; i < product.rows() && above + i <= at + k; ++i)
            triplets.emplace_back(above + i, at + k, product(i, k));
      }
    }
  }
  SparseMatrix h{num_eliminated + num_kept, num_eliminated + num_kept};
  h.setFromTriplets(triplets.begin(), triplets.end());
  solver_.compute(h);
  if (!has_solution()) return;

  // H = L D L': the lower right corners of L and D are those of the Schur complement.
  const auto& l = solver_.matrixL().nestedExpression();
  corner_root_ = Eigen::MatrixXd::Identity(num_kept, num_kept);
  for (Eigen::Index k = 0; k < num_kept; ++k)
    for (SparseMatrix::InnerIterator entry{l, num_eliminated + k}; entry; ++entry)
      if (entry.row() > entry.col()) corner_root_(entry.row() - num_eliminated, k) = entry.value();
  forward_ = std::move(g);
  solver_.matrixL().solveInPlace(forward_);
}

bool Elimination::has_solution() const {
  return solver_.info() == Eigen::Success && solver_.vectorD().allFinite();
}

Eigen::MatrixXd Elimination::corner_h() const {
  Eigen::MatrixXd h;
  h.noalias() =
      corner_root_ * solver_.vectorD().tail(num_kept_).asDiagonal() * corner_root_.transpose();
  h.diagonal().array() -= 1.0;
  return h;
}

Eigen::VectorXd Elimination::corner_g() const {
  return corner_root_ * forward_.tail(num_kept_);
}

Eigen::VectorXd Elimination::step(const Eigen::VectorXd& corner_step) const {
  const Eigen::Index num_eliminated = order_.size();
  Eigen::VectorXd x = forward_;
  x.head(num_eliminated) =
      -x.head(num_eliminated).cwiseQuotient(solver_.vectorD().head(num_eliminated));
  x.tail(num_kept_).noalias() = corner_root_.transpose() * corner_step;
  solver_.matrixU().solveInPlace(x);
  return x.head(num_eliminated);
}

}  // namespace waymark
