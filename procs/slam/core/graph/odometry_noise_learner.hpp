// SPDX-License-Identifier: BSD-3-Clause
// Learns how much larger the odometry's noise is than configured, from innovations.
#pragma once

#include "slam/core/graph/factors.hpp"

#include <array>
#include <cstddef>

namespace waymark {

/// One axis of an innovation: observed minus predicted, and the parts of its variance.
struct OdometryInnovation {
  double value{0.0};
  double odometry_variance{0.0};  ///< by the odometry's noise as configured
  double other_variance{0.0};     ///< by all else
  double distance_m{0.0};         ///< driven since the prediction began
};

/// A bank of models (Magill 1965), one for each noise scale of a grid; their log-likelihoods of the
/// innovations (Mehra 1972) fade exponentially. scale() is the mean over the bank.
///
/// Slips must not count as noise: in each model an innovation may also come from a wide component,
/// as in likeliest_kind() of factors.hpp. A slip in the turn may continue: a wheel that spins over
/// a wet floor exaggerates every step by the same share, while noise differs from step to step.
/// Along the path successive innovations are correlated anyway, for it takes some of them until the
/// pose has followed a marker. The scales of both axes are coupled by a prior: noise in the turn,
/// which walls observe everywhere, is probably as large along the path, which a bare corridor does
/// not observe.
///
/// Where neither markers nor walls observe them, slips add mean and variance to the motion along
/// the path: the first two moments per metre of those that markers showed (a compound Poisson
/// process, with pseudo-observations as its prior).
class OdometryNoiseLearner {
 public:
  void observe_along(const OdometryInnovation& innovation) { along_.add(innovation); }

  void observe_turn(const OdometryInnovation& innovation) { turn_.add(innovation); }

  /// Along the path, by a marker. Scans are not used: along a corridor they are pulled back to
  /// where the scans before were matched, which looks like a slip.
  void observe_slip(const OdometryInnovation& innovation);

  OdometryScale scale() const;

  int num_slips() const { return num_slips_; }

 private:
  static constexpr std::size_t kScales = 12;  ///< 1, sqrt(2), 2 ... 45

  /// Log-likelihoods of all scales, given the innovations of one axis.
  class Axis {
   public:
    explicit Axis(bool slips_go_on) : slips_go_on_{slips_go_on} {}

    void add(const OdometryInnovation& innovation);

    double log_likelihood(std::size_t scale) const { return models_[scale].log_likelihood; }

   private:
    struct Model {
      double log_likelihood{0.0};
      bool slips{false};  ///< by this model the newest innovation was a slip
    };

    std::array<Model, kScales> models_{};
    OdometryInnovation last_{};
    bool slips_go_on_{false};
  };

  static double scale_at(std::size_t i);
  double slip_m2_per_m() const;

  Axis along_{false};
  Axis turn_{true};
  // Sums that fade with the distance:
  double slips_{0.0};
  double slips_m_{0.0};
  double slips_m2_{0.0};    ///< of squares
  double observed_m_{0.0};  ///< driven where a slip would have been observed
  int num_slips_{0};
  double slip_m_{0.0};  ///< the newest slip, while innovations still show it; 0: none
};

}  // namespace waymark
