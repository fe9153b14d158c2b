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
  double distance_m{0.0};         ///< driven meanwhile
};

/// Mean variance over a grid of noise scales, each with the posterior probability of what was seen;
/// old innovations are forgotten slowly. A slip is no noise: an innovation may come from a wide
/// component of the mixture (likeliest_kind() in factors.hpp). In the turn those after it may go on
/// as it was: a wheel that spins over a wet floor turns too far by the same share of each step,
/// and noise changes from step to step. Along the way innovations follow each other anyway, for
/// the pose is drawn to a marker within some of them. Wheels that are bad in
/// the turn, which walls show everywhere, are probably as bad along the way, which a bare corridor
/// does not show. Source: innovation-based adaptive estimation (Mehra 1972), as a bank of models
/// (Magill 1965).
///
/// Slips along the way are no noise of wheels that roll, but where nothing shows them they add to
/// the variance all the same: the first two moments of those that were seen, by metre (a compound
/// Poisson process, with pseudo-observations as its prior).
class OdometryNoiseLearner {
 public:
  void observe_along(const OdometryInnovation& innovation) { along_.add(innovation); }

  void observe_turn(const OdometryInnovation& innovation) { turn_.add(innovation); }

  /// The same of a marker: it shows a slip, or none. Scans are not used, for along a corridor
  /// they are pulled back to where they were matched before, which looks like a slip.
  void observe_slip(const OdometryInnovation& innovation);

  OdometryScale scale() const;

  int num_slips() const { return num_slips_; }

 private:
  static constexpr std::size_t kScales = 12;  ///< 1, sqrt(2), 2 ... 45

  /// What the innovations of one axis say of every scale.
  class Axis {
   public:
    explicit Axis(bool slips_go_on) : slips_go_on_{slips_go_on} {}

    void add(const OdometryInnovation& innovation);

    double log_likelihood(std::size_t scale) const { return models_[scale].log_likelihood; }

   private:
    struct Model {
      double log_likelihood{0.0};
      bool slips{false};  ///< the newest innovation was a slip, if the wheels are that noisy
    };

    std::array<Model, kScales> models_{};
    OdometryInnovation last_{};
    bool slips_go_on_{false};
  };

  static double scale_at(std::size_t i);
  double slip_m2_per_m() const;

  Axis along_{false};
  Axis turn_{true};
  double slips_m_{0.0};     ///< sum, forgotten with the distance
  double slips_m2_{0.0};    ///< sum of squares, forgotten alike
  double observed_m_{0.0};  ///< driven where slips would have shown, forgotten alike
  int num_slips_{0};
  double slip_m_{0.0};  ///< the one that is being followed
};

}  // namespace waymark
