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

/// The robot's description as a prior, and measurements of the camera by walls and by perspective:
/// all linear in the calibration, so that their sum is one quadratic. The prior is a scale mixture
/// of normal distributions, which has the long tails of a Student-t: a term whose description the
/// measurements contradict by many standard deviations gets a prior that much wider (West 1987, "On
/// scale mixtures of normal distributions").
class CalibrationKnowledge {
 public:
  /// @param sigmas  standard deviations of the description, units as in Calibration; 0: exact.
  explicit CalibrationKnowledge(const Calibration& sigmas);

  void observe(const WallInnovation& wall);
  void observe(const FocalSighting& focal);

  /// Multiplies the information of all observations by `share`.
  void fade(double share);

  /// Variances that the calibration's random walk adds over `driven_m`: payload, tyre pressure and
  /// knocks change it. After kMemory_m the walk's variance equals the prior's.
  Calibration wander(double driven_m) const {
    return driven_m / kMemory_m * prior_information().cwiseInverse();
  }

  static constexpr double kMemory_m = 1000.0;

  /// Adds prior and observations to the normal equations H step = -g, linearised at `value`.
  void add_to(const Calibration& value, Eigen::Ref<Eigen::MatrixXd> h,
              Eigen::Ref<Eigen::VectorXd> g) const;

  /// Chooses the likeliest components of the mixtures: one for each term of the odometry, and a
  /// common one for the camera's terms. If that common component is wide, the camera's description
  /// is unreliable, and none of its terms gets a prior narrower than the usual one
  /// (SightingNoise::calibration).
  /// @param value      estimate with the components chosen previously.
  /// @param variances  of `value`.
  void weigh(const Calibration& value, const Calibration& variances);

  /// Indices, ascending, of the terms whose estimate is more than 5 configured standard deviations
  /// from the description.
  std::vector<std::size_t> doubted_terms(const Calibration& value) const;

 private:
  void weigh(std::initializer_list<Eigen::Index> terms, const Calibration& value,
             const Calibration& variances);

  Calibration prior_information() const {
    return widened_.cwiseProduct(sigmas_).cwiseAbs2().cwiseInverse();
  }

  Calibration sigmas_;
  Calibration widened_{
      Calibration::Ones()};  ///< width of the chosen component, a factor on sigmas_
  Eigen::Matrix3d camera_information_{Eigen::Matrix3d::Zero()};
  Eigen::Vector3d camera_vector_{Eigen::Vector3d::Zero()};  ///< information * measured value
};

}  // namespace waymark
