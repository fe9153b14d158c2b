// SPDX-License-Identifier: BSD-3-Clause
#include "slam/core/graph/odometry_noise_learner.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace waymark {
namespace {

constexpr double kMemory = 0.99;       // of an innovation, at the next one
constexpr double kPriorDecades = 3.0;  // log-odds of the description against any worse scale
constexpr double kCoupling = 0.7;      // standard deviation of log(along / turn)
constexpr double kSlipFactor = 5.0;    // as the second component of OdometryMixture
const double kLogSlipShare = std::log(0.03);

double squared(double x) {
  return x * x;
}

double log_normal(double value, double variance) {
  return -0.5 * (std::log(variance) + squared(value) / variance);
}

}  // namespace

double OdometryNoiseLearner::scale_at(std::size_t i) {
  return std::pow(2.0, 0.5 * static_cast<double>(i));
}

void OdometryNoiseLearner::add(const OdometryInnovation& innovation, LogLikelihoods& to) {
  for (std::size_t i = 0; i < kScales; ++i) {
    const double by_odometry = squared(scale_at(i)) * innovation.odometry_variance;
    const double rolls = log_normal(innovation.value, innovation.other_variance + by_odometry);
    const double slips =
        kLogSlipShare + log_normal(innovation.value,
                                   innovation.other_variance + squared(kSlipFactor) * by_odometry);
    to[i] = kMemory * to[i] + std::max(rolls, slips);
  }
}

OdometryScale OdometryNoiseLearner::scale() const {
  double best = -std::numeric_limits<double>::infinity();
  OdometryScale scale;
  for (std::size_t a = 0; a < kScales; ++a) {
    for (std::size_t t = 0; t < kScales; ++t) {
      const double apart = std::log(scale_at(a) / scale_at(t)) / kCoupling;
      const double log_posterior = along_[a] + turn_[t] - 0.5 * squared(apart) -
                                   (a > 0 ? kPriorDecades : 0.0) - (t > 0 ? kPriorDecades : 0.0);
      if (log_posterior <= best) continue;
      best = log_posterior;
      scale = {scale_at(a), scale_at(t)};
    }
  }
  return scale;
}

}  // namespace waymark
