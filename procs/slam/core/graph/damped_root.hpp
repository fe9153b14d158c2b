// SPDX-License-Identifier: BSD-3-Clause
// The Cholesky decomposition of normal equations.
#pragma once

#include <Eigen/Cholesky>

namespace waymark {

/// L of h = L L'. Where some unknowns are known to micrometres and others to kilometres, rounding
/// may leave h indefinite: it is damped as little as it needs then (Levenberg 1944).
class DampedRoot : public Eigen::LLT<Eigen::MatrixXd, Eigen::Lower> {
 public:
  /// @param h  symmetric, the lower half counts; without a diagonal that is zero or below.
  void compute(const Eigen::MatrixXd& h) {
    LLT::compute(h);
    for (double damping = kLeast; info() != Eigen::Success && damping < kMost; damping *= 10.0) {
      Eigen::MatrixXd damped = h;
      damped.diagonal() *= 1.0 + damping;
      LLT::compute(damped);
    }
  }

 private:
  static constexpr double kLeast = 1e-12;  ///< share of the diagonal
  static constexpr double kMost = 10.0;
};

}  // namespace waymark
