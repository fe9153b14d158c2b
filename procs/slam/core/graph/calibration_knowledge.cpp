// SPDX-License-Identifier: BSD-3-Clause
#include "slam/core/graph/calibration_knowledge.hpp"

#include "common/geometry/squared.hpp"

#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <limits>

namespace waymark {
namespace {

// The prior is a mixture of normals with 1, 2, 4, ..., kWidest times the configured sigma.
constexpr double kWidest = 256.0;     // factor on the configured sigma
constexpr double kTail = 2.0;         // the weight of the normal with factor k is 1 / k^kTail
constexpr double kMinShare = 1e-9;    // information relative to the prior's; less is rounding
constexpr double kDoubtSigmas = 5.0;  // error beyond which the description counts as wrong
constexpr double kWide = 8.0;         // width from which the camera's sigmas count as unreliable
constexpr double kExactSigma = 1e-9;  // stands for 0, which has no inverse

}  // namespace

CalibrationKnowledge::CalibrationKnowledge(const Calibration& sigmas)
    : sigmas_{sigmas.cwiseMax(kExactSigma)} {}

void CalibrationKnowledge::observe(const WallInnovation& wall) {
  const Eigen::Matrix<double, 2, 3> jacobian = wall.jacobian_calibration();
  const Eigen::Matrix2d information = wall.covariance.inverse();
  camera_information_ += jacobian.transpose() * information * jacobian;
  camera_vector_ += jacobian.transpose() * information * wall.residual;
}

void CalibrationKnowledge::fade(double share) {
  camera_information_ *= share;
  camera_vector_ *= share;
}

void CalibrationKnowledge::choose_prior_widths(const Calibration& value,
                                               const Calibration& variances) {
  for (Eigen::Index term = 0; term < kOdometryTerms; ++term)
    choose_prior_widths({term}, value, variances);
  choose_prior_widths({kOdometryTerms, kOdometryTerms + 1, kOdometryTerms + 2}, value, variances);
  const Eigen::Vector3d usual = SightingNoise{}.calibration;
  for (Eigen::Index i = 0; i < kCameraTerms; ++i) {
    double& width = widths_[kOdometryTerms + i];
    if (width >= kWide) width = std::max(width, usual[i] / sigmas_[kOdometryTerms + i]);
  }
}

/// Removes the prior, whose mean is 0, from the estimate: what remains are the mean and information
/// of the measurements alone. Exact terms are left as they are. A term without a finite mean and
/// variance (the window's equations were singular) does not influence the choice.
void CalibrationKnowledge::choose_prior_widths(std::initializer_list<Eigen::Index> terms,
                                               const Calibration& value,
                                               const Calibration& variances) {
  const Calibration prior = prior_information();
  double least = std::numeric_limits<double>::infinity();
  double likeliest = 1.0;
  for (double factor = 1.0; factor <= kWidest; factor *= 2.0) {
    double cost = 2.0 * kTail * std::log(factor);
    for (const Eigen::Index term : terms) {
      const double information = 1.0 / variances[term] - prior[term];
      const double measured = value[term] / (variances[term] * information);
      const bool is_measured = information > kMinShare * prior[term] && std::isfinite(measured);
      if (sigmas_[term] <= kExactSigma || !is_measured) continue;
      const double variance = squared(factor * sigmas_[term]) + 1.0 / information;
      cost += std::log(variance) + squared(measured) / variance;
    }
    if (cost >= least) continue;
    least = cost;
    likeliest = factor;
  }
  for (const Eigen::Index term : terms)
    if (sigmas_[term] > kExactSigma) widths_[term] = likeliest;
}

void CalibrationKnowledge::add_to(const Calibration& value, Eigen::Ref<Eigen::MatrixXd> h,
                                  Eigen::Ref<Eigen::VectorXd> g) const {
  const Calibration prior = prior_information();
  h.diagonal() += prior;
  g += prior.cwiseProduct(value);
  h.block<3, 3>(kOdometryTerms, kOdometryTerms) += camera_information_;
  g.segment<3>(kOdometryTerms) += camera_information_ * camera_part(value) - camera_vector_;
}

std::vector<std::size_t> CalibrationKnowledge::doubted_terms(const Calibration& value) const {
  std::vector<std::size_t> terms;
  for (Eigen::Index i = 0; i < value.size(); ++i)
    if (std::abs(value[i]) > kDoubtSigmas * sigmas_[i])
      terms.push_back(static_cast<std::size_t>(i));
  return terms;
}

}  // namespace waymark
