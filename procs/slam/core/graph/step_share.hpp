// SPDX-License-Identifier: BSD-3-Clause
// Step length of Gauss-Newton.
#pragma once

#include "slam/core/graph/state.hpp"

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <vector>

namespace waymark {

/// Share of a step to take: all of it, unless it turns a pose so far that the linearisation is
/// invalid.
/// @param turn_rad  the largest turn in the step.
inline double step_share(double turn_rad) {
  constexpr double kMax_rad = 0.5;
  return turn_rad > kMax_rad ? kMax_rad / turn_rad : 1.0;
}

/// step_share() for the largest turn of a keyframe in `step`.
/// @param place_of  index of a variable in `step`.
template <class PlaceOf>
double step_share(const Eigen::VectorXd& step, const std::vector<Variable>& variables,
                  const PlaceOf& place_of) {
  double turn_rad = 0.0;
  for (const Variable& variable : variables)
    if (variable.kind == VariableKind::kKeyframe)
      turn_rad = std::max(turn_rad, std::abs(step[place_of(variable) + 2]));
  return step_share(turn_rad);
}

}  // namespace waymark
