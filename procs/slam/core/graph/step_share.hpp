// SPDX-License-Identifier: BSD-3-Clause
// Step length of Gauss-Newton.
#pragma once

#include "slam/core/graph/state.hpp"

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <vector>

namespace waymark {

/// Share of the step to take: all of it, unless it turns a keyframe so far that the linearisation
/// of its factors does not hold.
/// @param place_of  index of a variable in `step`.
template <class PlaceOf>
double step_share(const Eigen::VectorXd& step, const std::vector<Variable>& variables,
                  const PlaceOf& place_of) {
  constexpr double kMost_rad = 0.5;
  double turn_rad = 0.0;
  for (const Variable& variable : variables)
    if (variable.kind == VariableKind::kKeyframe)
      turn_rad = std::max(turn_rad, std::abs(step[place_of(variable) + 2]));
  return turn_rad > kMost_rad ? kMost_rad / turn_rad : 1.0;
}

}  // namespace waymark
