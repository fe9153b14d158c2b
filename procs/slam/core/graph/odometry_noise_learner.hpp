// SPDX-License-Identifier: BSD-3-Clause
// How much worse the odometry is than described, from how far observations are off its predictions.
#pragma once

#include "slam/core/graph/factors.hpp"

#include <array>
#include <cstddef>

namespace waymark {

/// One axis of an innovation: observed minus predicted, and why they may differ.
struct OdometryInnovation {
  double value{0.0};
  double odometry_variance{0.0};  ///< by the odometry's noise as configured
  double other_variance{0.0};     ///< by all else
};

/// Maximum a posteriori over a grid of noise scales, each with the log-likelihood of what was seen;
/// old innovations are forgotten slowly. A single slip is no noise: innovations may come from the
/// wide components of OdometryMixture. Wheels that are bad in the turn, which walls show
/// everywhere, are probably as bad along the way, which a bare corridor does not show. Source:
/// innovation-based adaptive estimation (Mehra 1972), as a bank of models (Magill 1965).
class OdometryNoiseLearner {
 public:
  void observe_along(const OdometryInnovation& innovation) { add(innovation, along_); }

  void observe_turn(const OdometryInnovation& innovation) { add(innovation, turn_); }

  OdometryScale scale() const;

 private:
  static constexpr std::size_t kScales = 12;  ///< 1, sqrt(2), 2 ... 45
  using LogLikelihoods = std::array<double, kScales>;

  static double scale_at(std::size_t i);
  static void add(const OdometryInnovation& innovation, LogLikelihoods& to);

  LogLikelihoods along_{};
  LogLikelihoods turn_{};
};

}  // namespace waymark
