// SPDX-License-Identifier: BSD-3-Clause
// The Gaussian that a particle's next pose is drawn from: odometry, walls and markers together.
#pragma once

#include "slam/core/proposal/pose_information.hpp"

#include <functional>

namespace waymark {

struct PoseProposal {
  Se2 mean{};
  Eigen::Matrix3d covariance{Eigen::Matrix3d::Zero()};  ///< (x, y, theta), map frame
  double log_evidence{0.0};  ///< of the measurements given the prior, up to their constants
};

/// Measurements as a second-order model of their negative log-likelihood about a pose, given how
/// uncertain that pose still is: robust models judge outliers by it.
using MeasurementModel =
    std::function<PoseInformation(const Se2& pose, const Eigen::Matrix3d& uncertainty)>;

/// Fuses a Gaussian prior with measurements, each a second-order model of its negative
/// log-likelihood about a given pose, by Gauss-Newton steps. The evidence is Laplace's.
/// Source: Montemerlo et al. (2003), "FastSLAM 2.0", equations 6-16.
/// @param start  where the steps begin: measurements may have more than one minimum.
PoseProposal propose(const Se2& prior_mean, const Eigen::Matrix3d& prior_covariance,
                     const MeasurementModel& measurements, const Se2& start);

/// The same, beginning at the prior's mean.
inline PoseProposal propose(const Se2& prior_mean, const Eigen::Matrix3d& prior_covariance,
                            const MeasurementModel& measurements) {
  return propose(prior_mean, prior_covariance, measurements, prior_mean);
}

}  // namespace waymark
