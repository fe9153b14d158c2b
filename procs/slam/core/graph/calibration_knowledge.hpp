// SPDX-License-Identifier: BSD-3-Clause
// What is known of the calibration apart from poses and markers.
#pragma once

#include "slam/core/graph/state.hpp"
#include "slam/core/landmark/marker_measurement.hpp"

#include <Eigen/Core>

namespace waymark {

/// The robot's description as a prior, and what walls and perspective say about the camera: linear
/// in the calibration, so that their sum is one quadratic. The description is believed as a
/// Student-t distribution: what is found to be many standard deviations off is doubted, and then
/// measurements decide (Lange, Little, Taylor 1989).
class CalibrationKnowledge {
 public:
  /// @param sigmas  of the description; 0 is exact.
  explicit CalibrationKnowledge(const Calibration& sigmas);

  void observe(const WallInnovation& wall);
  void observe(const FocalSighting& focal);

  /// Adds to the normal equations H step = -g at a value of the calibration.
  void add_to(const Calibration& value, Eigen::Ref<Eigen::MatrixXd> h,
              Eigen::Ref<Eigen::VectorXd> g) const;

  /// The description is off by more than chance explains.
  bool is_doubted(const Calibration& value) const;

 private:
  double prior_weight(Eigen::Index term, double value) const;

  Calibration sigmas_;
  Eigen::Matrix3d camera_information_{Eigen::Matrix3d::Zero()};
  Eigen::Vector3d camera_vector_{Eigen::Vector3d::Zero()};  ///< information * what is measured
};

}  // namespace waymark
