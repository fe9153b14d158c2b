// SPDX-License-Identifier: BSD-3-Clause
// Sparse elimination of most unknowns, which leaves dense normal equations of a few.
#pragma once

#include "slam/core/graph/factors.hpp"

#include <Eigen/Core>
#include <Eigen/SparseCholesky>

#include <array>
#include <functional>
#include <vector>

namespace waymark {

/// Normal equations H x = -g of linear factors. Keyframes and landmarks are eliminated. The
/// unknowns that are kept come last: the lower right corner of H. Cost: about linear in the number
/// of factors.
class Elimination {
 public:
  /// @param eliminated     keyframes and landmarks.
  /// @param num_kept       unknowns in the corner.
  /// @param place_in_corner  index in the corner of a variable that is not eliminated.
  Elimination(const std::vector<Variable>& eliminated, const std::vector<LinearFactor>& factors,
              Eigen::Index num_kept,
              const std::function<Eigen::Index(const Variable&)>& place_in_corner);

  bool has_solution() const;

  /// Index of an eliminated variable in step().
  Eigen::Index place_of(const Variable& variable) const { return order_.place_of(variable); }

  /// Information of the corner, the Schur complement. O(num_kept^3).
  Eigen::MatrixXd corner_h() const;
  Eigen::VectorXd corner_g() const;

  /// Back-substitution.
  /// @param corner_step  of the unknowns that are kept.
  /// @return the step of the eliminated ones.
  Eigen::VectorXd step(const Eigen::VectorXd& corner_step) const;

 private:
  using SparseMatrix = Eigen::SparseMatrix<double>;
  using Solver = Eigen::SimplicialLDLT<SparseMatrix, Eigen::Upper, Eigen::NaturalOrdering<int>>;

  /// Places of the eliminated unknowns, in an order that keeps the factorisation sparse.
  class Order {
   public:
    Order(const std::vector<Variable>& variables, const std::vector<LinearFactor>& factors);

    Eigen::Index size() const { return 3 * std::ssize(place_); }

    bool has(const Variable& variable) const { return number_of(variable) >= 0; }

    Eigen::Index place_of(const Variable& variable) const {
      return 3 * place_[static_cast<std::size_t>(number_of(variable))];
    }

   private:
    /// Position among the eliminated variables; negative: it is kept.
    Eigen::Index number_of(const Variable& variable) const;

    std::array<std::vector<Eigen::Index>, 3> numbers_{};  ///< by VariableKind and index; -1: none
    std::vector<Eigen::Index> place_{};  ///< in the elimination, by number; in blocks of three
  };

  Order order_;
  Eigen::Index num_kept_;
  Solver solver_{};
  Eigen::MatrixXd corner_root_{};  ///< lower triangular, ones on the diagonal
  Eigen::VectorXd forward_{};      ///< L^-1 g
};

}  // namespace waymark
