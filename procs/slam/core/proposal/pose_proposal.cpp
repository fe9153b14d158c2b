// SPDX-License-Identifier: BSD-3-Clause
#include "slam/core/proposal/pose_proposal.hpp"

#include <Eigen/Cholesky>
#include <Eigen/LU>

namespace waymark {
namespace {

constexpr int kMaxSteps = 6;
constexpr double kShrink = 0.25;     // of the uncertainty, by a step
constexpr double kSmallStep = 2e-4;  // [m, rad] well below what a scan tells

}  // namespace

PoseProposal propose(const Se2& prior_mean, const Eigen::Matrix3d& prior_covariance,
                     const MeasurementModel& measurements, const Se2& start) {
  const Eigen::Matrix3d prior_information = prior_covariance.inverse();
  PoseProposal proposal;
  proposal.mean = start;
  PoseInformation measured;
  Eigen::Vector3d from_prior = Eigen::Vector3d::Zero();
  Eigen::Matrix3d information;
  Eigen::Matrix3d uncertainty = prior_covariance;
  for (int step = 0; step < kMaxSteps; ++step) {
    measured = measurements(proposal.mean, uncertainty);
    uncertainty *= kShrink;
    from_prior = deviation(prior_mean, proposal.mean);
    information = prior_information + measured.information;
    const Eigen::Vector3d move =
        -information.ldlt().solve(prior_information * from_prior + measured.gradient);
    if (move.norm() < kSmallStep) break;
    proposal.mean = deviated(proposal.mean, move);
  }
  proposal.covariance = information.inverse();
  proposal.log_evidence =
      -measured.cost - 0.5 * from_prior.dot(prior_information * from_prior) -
      0.5 * std::log(information.determinant() * prior_covariance.determinant());
  return proposal;
}

}  // namespace waymark
