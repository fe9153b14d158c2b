// SPDX-License-Identifier: BSD-3-Clause
// Cost of a subset of the survey's priors, from the surveyed landmarks alone.
#pragma once

#include "slam/core/graph/graph.hpp"

#include <vector>

namespace waymark {

/// Graph::marginal_of() has eliminated all other variables. The marginal's cost is quadratic in the
/// landmarks' own frames, so it stays valid when all of them turn; only the priors are linearised
/// again.
class SurveyModel {
 public:
  struct Solution {
    double cost{0.0};  ///< chi^2, relative to that of the measurements at the linearisation point
    State state{};     ///< landmarks as in the marginal
    Eigen::MatrixXd covariance{};  ///< of the landmarks, in their own frames
  };

  explicit SurveyModel(LandmarkMarginal marginal) : marginal_{std::move(marginal)} {}

  /// O(number of landmarks ^ 3).
  /// @param priors  `landmark` is an index in the marginal. Those with is_off are ignored; the
  ///                others must determine the map's position and heading.
  Solution solve(const std::vector<LandmarkPrior>& priors) const;

  /// The least cost of the measurements alone.
  double cost_without_priors() const;

 private:
  LandmarkMarginal marginal_;
};

/// By how much the cost falls, to first order, if a prior is left out (Baarda 1968, "A testing
/// procedure for use in geodetic networks"). The others must determine the frame.
/// @param solution  with that prior.
double saving_without(const LandmarkPrior& prior, const SurveyModel::Solution& solution);

}  // namespace waymark
