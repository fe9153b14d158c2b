// SPDX-License-Identifier: BSD-3-Clause
#include "slam/core/graph/calibration_knowledge.hpp"

#include <Eigen/LU>

#include <cmath>

namespace waymark {
namespace {

constexpr double kDegrees = 5.0;      // of freedom of the Student-t distribution
constexpr double kDoubtSigmas = 5.0;  // beyond, the description is called wrong
constexpr double kExactSigma = 1e-9;  // instead of 0

}  // namespace

CalibrationKnowledge::CalibrationKnowledge(const Calibration& sigmas)
    : sigmas_{sigmas.cwiseMax(kExactSigma)} {}

void CalibrationKnowledge::observe(const WallInnovation& wall) {
  const Eigen::Matrix<double, 2, 3> by = wall.by_errors();
  const Eigen::Matrix2d information = wall.covariance.inverse();
  camera_information_ += by.transpose() * information * by;
  camera_vector_ += by.transpose() * information * wall.residual;
}

void CalibrationKnowledge::observe(const FocalSighting& focal) {
  const double information = 1.0 / (focal.sigma * focal.sigma);
  camera_information_(SightingSigmas::kFocal, SightingSigmas::kFocal) += information;
  camera_vector_[SightingSigmas::kFocal] += information * focal.error;
}

/// An exact value stays exact.
double CalibrationKnowledge::prior_weight(Eigen::Index term, double value) const {
  const double chi2 = (value / sigmas_[term]) * (value / sigmas_[term]);
  const double robust = sigmas_[term] > kExactSigma ? (kDegrees + 1.0) / (kDegrees + chi2) : 1.0;
  return std::min(1.0, robust) / (sigmas_[term] * sigmas_[term]);
}

void CalibrationKnowledge::add_to(const Calibration& value, Eigen::Ref<Eigen::MatrixXd> h,
                                  Eigen::Ref<Eigen::VectorXd> g) const {
  for (Eigen::Index term = 0; term < kCalibrationSize; ++term) {
    const double weight = prior_weight(term, value[term]);
    h(term, term) += weight;
    g[term] += weight * value[term];
  }
  h.block<3, 3>(kOdometryTerms, kOdometryTerms) += camera_information_;
  g.segment<3>(kOdometryTerms) += camera_information_ * camera_part(value) - camera_vector_;
}

bool CalibrationKnowledge::is_doubted(const Calibration& value) const {
  return (value.cwiseAbs().array() > kDoubtSigmas * sigmas_.array()).any();
}

}  // namespace waymark
