// SPDX-License-Identifier: BSD-3-Clause
// The Cholesky decomposition of normal equations.
#pragma once

#include <Eigen/Cholesky>

namespace waymark {

/// L of h = L L'. Where standard deviations range from micrometres to kilometres, rounding may make
/// h indefinite: then h is damped, as little as necessary (Levenberg 1944).
class DampedRoot : public Eigen::LLT<Eigen::MatrixXd, Eigen::Lower> {
 public:
  /// @param h  symmetric, diagonal positive; only the lower triangle is read.
  void compute(const Eigen::MatrixXd& h) {
    LLT::compute(h);
    for (double damping = kMinDamping; info() != Eigen::Success && damping < kMaxDamping;
         damping *= 10.0) {
      Eigen::MatrixXd damped = h;
      damped.diagonal() *= 1.0 + damping;
      LLT::compute(damped);
    }
  }

 private:
  static constexpr double kMinDamping = 1e-12;  ///< share of the diagonal
  static constexpr double kMaxDamping = 10.0;
};

}  // namespace waymark
