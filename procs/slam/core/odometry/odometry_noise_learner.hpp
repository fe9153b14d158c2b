// SPDX-License-Identifier: BSD-3-Clause
// Learns how much larger the odometry's noise is than configured, from innovations.
#pragma once

#include "slam/core/motion/odometry_mixture.hpp"

#include <array>
#include <cstddef>

namespace waymark {

/// One axis of an innovation: observed minus predicted, and the parts of its variance.
struct OdometryInnovation {
  double value{0.0};
  double odometry_variance{0.0};  ///< from the odometry's noise as configured
  double other_variance{0.0};     ///< from all other sources
  double distance_m{0.0};         ///< driven since the prediction began
};

/// A bank of models (Magill 1965), one for each noise scale of a grid; their log-likelihoods of the
/// innovations (Mehra 1972) fade exponentially. learnt_noise() is the posterior root mean square.
///
/// Slips must not count as noise, so each model also has a wide component for them, like
/// likeliest_kind() of odometry_mixture.hpp. In the turn a slip may last: a wheel that spins on a
/// wet floor overcounts each step by the same share, while noise differs from step to step. Not so
/// along the path: there, successive innovations are correlated until the pose has followed a
/// marker. A prior couples the scales of both axes: noise in the turn, which walls observe
/// everywhere, is probably as large along the path, which is unobservable in a bare corridor.
///
/// Where neither markers nor walls observe slips, slips add mean and variance to the motion along
/// the path: the first two moments per metre of the slips that markers have observed (a compound
/// Poisson process, with pseudo-observations as its prior).
class OdometryNoiseLearner {
 public:
  void observe_along(const OdometryInnovation& innovation) { along_.add(innovation); }

  void observe_turn(const OdometryInnovation& innovation) { turn_.add(innovation); }

  /// Innovation along the path, from a marker. Scans are not used: in a corridor they are pulled
  /// back to where the previous scans were matched, which looks like a slip.
  void observe_slip(const OdometryInnovation& innovation);

  LearntOdometryNoise learnt_noise() const;

  int num_slips() const { return num_slips_; }

 private:
  static constexpr std::size_t kScales = 12;  ///< 1, sqrt(2), 2 ... 45

  /// Log-likelihoods of all scales, given the innovations of one axis.
  class Axis {
   public:
    explicit Axis(bool slips_may_last) : slips_may_last_{slips_may_last} {}

    void add(const OdometryInnovation& innovation);

    double log_likelihood(std::size_t scale) const { return models_[scale].log_likelihood; }

   private:
    struct Model {
      double log_likelihood{0.0};
      bool slips{false};  ///< the newest innovation was a slip that may continue
    };

    std::array<Model, kScales> models_{};
    OdometryInnovation last_{};
    bool slips_may_last_{false};
  };

  static double scale_at(std::size_t i);
  double slip_m2_per_m() const;

  Axis along_{false};
  Axis turn_{true};
  // Sums that fade with the distance:
  double slips_{0.0};       ///< number of slips
  double slips_m_{0.0};     ///< sum of their sizes, signed
  double slips_m2_{0.0};    ///< sum of their squared sizes
  double observed_m_{0.0};  ///< distance driven where a slip would have been observed
  int num_slips_{0};
  double slip_m_{0.0};  ///< the newest slip, while innovations still show it; 0: none
};

}  // namespace waymark
