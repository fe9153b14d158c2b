// SPDX-License-Identifier: BSD-3-Clause
// Surveyed landmarks alone: what it costs to believe some of their priors, without the whole graph.
#pragma once

#include "slam/core/graph/graph.hpp"

#include <cstddef>
#include <vector>

namespace waymark {

/// Everything else has been eliminated, by Graph::marginal_of(). That is quadratic in the
/// landmarks' own frames, and so it holds when all of them turn; only the priors are linearised
/// again.
class SurveyModel {
 public:
  struct Solution {
    double cost{0.0};  ///< chi^2, above that of the measurements where they were linearised
    State state{};     ///< landmarks as in the marginal
    Eigen::MatrixXd covariance{};  ///< in their own frames
  };

  explicit SurveyModel(LandmarkMarginal marginal) : marginal_{std::move(marginal)} {}

  /// @param priors  on landmarks by their index in the marginal; they determine the frame. Those
  ///                that are off do not count. O(number of landmarks ^ 3).
  Solution solve(const std::vector<LandmarkPrior>& priors) const;

  /// The least cost of the measurements alone.
  double cost_without_priors() const;

 private:
  LandmarkMarginal marginal_;
};

/// By how much the cost falls, to first order, where that prior is left out (Baarda 1968, "A
/// testing procedure for use in geodetic networks"). The others determine the frame.
/// @param solution  with that prior.
double saving_without(const LandmarkPrior& prior, const SurveyModel::Solution& solution);

}  // namespace waymark
