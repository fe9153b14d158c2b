// SPDX-License-Identifier: BSD-3-Clause
// Information about the calibration that does not depend on poses and landmarks.
#pragma once

#include "slam/core/graph/state.hpp"
#include "slam/core/landmark/marker_measurement.hpp"

#include <Eigen/Core>

#include <cstddef>
#include <initializer_list>
#include <vector>

namespace waymark {

/// The robot's description as a prior, and measurements of the camera by walls:
/// all linear in the calibration, so that their sum is one quadratic. The prior is a scale mixture
/// of normal distributions, which has the long tails of a Student-t: a term whose description the
/// measurements contradict by many standard deviations gets a prior that much wider (West 1987, "On
/// scale mixtures of normal distributions").
class CalibrationKnowledge {
 public:
  /// @param sigmas  standard deviations of the description, units as in Calibration; 0: exact.
  explicit CalibrationKnowledge(const Calibration& sigmas);

  void observe(const WallInnovation& wall);

  /// Multiplies the information of all observations by `share`.
  void fade(double share);

  /// Variances that the calibration's random walk adds over `driven_m`: payload, tyre pressure and
  /// knocks change the calibration. After kMemory_m the walk's variance equals the prior's.
  Calibration random_walk_variances(double driven_m) const {
    return driven_m / kMemory_m * prior_information().cwiseInverse();
  }

  static constexpr double kMemory_m = 1000.0;

  /// Adds prior and observations to the normal equations H step = -g, linearised at `value`.
  void add_to(const Calibration& value, Eigen::Ref<Eigen::MatrixXd> h,
              Eigen::Ref<Eigen::VectorXd> g) const;

  /// Chooses the likeliest width of the prior (component of the mixture): one for each odometry
  /// term, a common one for the three camera terms. If the latter is wide, the camera's configured
  /// sigmas are unreliable: none of its priors is narrower than the default one
  /// (SightingNoise::calibration).
  /// @param value      estimate with the widths chosen previously.
  /// @param variances  of `value`.
  void choose_prior_widths(const Calibration& value, const Calibration& variances);

  /// Indices, ascending, of the terms whose estimate is more than 5 configured standard deviations
  /// from the description.
  std::vector<std::size_t> doubted_terms(const Calibration& value) const;

 private:
  void choose_prior_widths(std::initializer_list<Eigen::Index> terms, const Calibration& value,
                           const Calibration& variances);

  Calibration prior_information() const {
    return widths_.cwiseProduct(sigmas_).cwiseAbs2().cwiseInverse();
  }

  Calibration sigmas_;
  Calibration widths_{Calibration::Ones()};  ///< chosen widths of the prior, factors on sigmas_
  Eigen::Matrix3d camera_information_{Eigen::Matrix3d::Zero()};
  Eigen::Vector3d camera_vector_{Eigen::Vector3d::Zero()};  ///< information * measured value
};

}  // namespace waymark
