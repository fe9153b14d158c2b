// SPDX-License-Identifier: BSD-3-Clause
// What is known of the calibration apart from poses and markers.
#pragma once

#include "slam/core/graph/state.hpp"
#include "slam/core/landmark/marker_measurement.hpp"

#include <Eigen/Core>

#include <initializer_list>

namespace waymark {

/// The robot's description as a prior, and what walls and perspective say about the camera: linear
/// in the calibration, so that their sum is one quadratic. The description is believed as a scale
/// mixture of normal distributions, which has the long tails of a Student-t: where measurements
/// alone say that a value is many standard deviations off, it is taken as that much less certain
/// (West 1987, "On scale mixtures of normal distributions").
class CalibrationKnowledge {
 public:
  /// @param sigmas  of the description; 0 is exact.
  explicit CalibrationKnowledge(const Calibration& sigmas);

  void observe(const WallInnovation& wall);
  void observe(const FocalSighting& focal);

  /// What was observed is forgotten but for `share`.
  void fade(double share);

  /// A random walk over `driven_m`: variances that it adds. A payload, a tyre or a knock changes a
  /// calibration; after kMemory_m little is left of what was known.
  Calibration wander(double driven_m) const {
    return driven_m / kMemory_m * prior_information().cwiseInverse();
  }

  static constexpr double kMemory_m = 1000.0;

  /// Adds to the normal equations H step = -g at a value of the calibration.
  void add_to(const Calibration& value, Eigen::Ref<Eigen::MatrixXd> h,
              Eigen::Ref<Eigen::VectorXd> g) const;

  /// Chooses the components of the mixtures: one of each term of the odometry, and one of all of
  /// the camera's, for a description that is wrong in one of them was not made
  /// carefully: it is believed no better than one that is usual.
  /// @param value      estimate with the components chosen before,
  /// @param variances  of it.
  void weigh(const Calibration& value, const Calibration& variances);

  /// The description is off by more than chance explains.
  bool is_doubted(const Calibration& value) const;

 private:
  void weigh(std::initializer_list<Eigen::Index> terms, const Calibration& value,
             const Calibration& variances);

  Calibration prior_information() const {
    return widened_.cwiseProduct(sigmas_).cwiseAbs2().cwiseInverse();
  }

  Calibration sigmas_;
  Calibration widened_{Calibration::Ones()};  ///< by the chosen component, a factor on the sigma
  Eigen::Matrix3d camera_information_{Eigen::Matrix3d::Zero()};
  Eigen::Vector3d camera_vector_{Eigen::Vector3d::Zero()};  ///< information * what is measured
};

}  // namespace waymark
