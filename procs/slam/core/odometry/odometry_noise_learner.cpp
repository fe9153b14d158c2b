// SPDX-License-Identifier: BSD-3-Clause
#include "slam/core/odometry/odometry_noise_learner.hpp"

#include "common/geometry/squared.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace waymark {
namespace {

// The bank of models. All constants were chosen, not fitted.
constexpr double kMemory = 0.99;        // forgetting factor of log-likelihoods per innovation
constexpr double kPriorLogOdds = 3.0;   // of the configured scale against each larger one
constexpr double kCoupling = 0.7;       // prior standard deviation of log(along / turn)
constexpr double kSlipFactor = 5.0;     // sigma of the odometry in a slip, relative to its noise
constexpr double kLastingSigmas = 5.0;  // a larger slip may continue at the next innovation
const double kLogSlipShare = std::log(0.03);  // of the probability of a slip, as kSlipPenalty

// Moments of slips along the path.
constexpr double kSlipSigmas = 4.0;       // a larger innovation is a slip
constexpr double kSlipShows_m = 0.03;     // sigma of all else below which a slip is observable
constexpr double kLongestSlip_m = 0.5;    // a larger innovation is no slip
constexpr double kForgotten_m = 50.0;     // distance over which the sums fade by a factor e
constexpr double kPriorSlips_m2 = 4e-4;   // pseudo-observation: one slip of 2 cm
constexpr double kPriorDistance_m = 5.0;  // within this distance
constexpr double kMeanIsUncertain = 1.5;  // factor on the variance: the mean is estimated, too

double log_normal(double value, double variance) {
  return -0.5 * (std::log(variance) + squared(value) / variance);
}

}  // namespace

double OdometryNoiseLearner::scale_at(std::size_t i) {
  return std::pow(2.0, 0.5 * static_cast<double>(i));
}

void OdometryNoiseLearner::Axis::add(const OdometryInnovation& innovation) {
  const double same_m = last_.distance_m > 0.0 ? innovation.distance_m / last_.distance_m : 0.0;
  const double change = innovation.value - same_m * last_.value;
  for (std::size_t i = 0; i < kScales; ++i) {
    Model& model = models_[i];
    const double odometry_variance = squared(scale_at(i)) * innovation.odometry_variance;
    const double rolling = innovation.other_variance + odometry_variance;
    const double rolls = log_normal(innovation.value, rolling);
    double slips = kLogSlipShare +
                   log_normal(innovation.value,
                              innovation.other_variance + squared(kSlipFactor) * odometry_variance);
    if (slips_may_last_ && model.slips)
      slips = std::max(slips, log_normal(change, (1.0 + squared(same_m)) * rolling));
    model.slips = slips > rolls && squared(innovation.value) > squared(kLastingSigmas) * rolling;
    model.log_likelihood = kMemory * model.log_likelihood + std::max(rolls, slips);
  }
  last_ = innovation;
}

void OdometryNoiseLearner::observe_slip(const OdometryInnovation& innovation) {
  const double rolling_m2 =
      innovation.other_variance + squared(learnt_noise().along) * innovation.odometry_variance;
  const double keeps = std::exp(-innovation.distance_m / kForgotten_m);
  slips_m_ *= keeps;
  slips_m2_ *= keeps;
  slips_ *= keeps;
  observed_m_ *= keeps;
  if (innovation.other_variance < squared(kSlipShows_m)) observed_m_ += innovation.distance_m;
  const double size_m = std::abs(innovation.value);
  if (size_m <= kSlipSigmas * std::sqrt(rolling_m2) || size_m > kLongestSlip_m) {
    slip_m_ = 0.0;
    return;
  }
  // A slip shows in several innovations until the pose has followed it: only the largest counts.
  if (slip_m_ == 0.0) {
    ++num_slips_;
    slips_ += 1.0;
  }
  if (size_m <= std::abs(slip_m_)) return;
  slips_m_ += innovation.value - slip_m_;
  slips_m2_ += squared(size_m) - squared(slip_m_);
  slip_m_ = innovation.value;
}

double OdometryNoiseLearner::slip_m2_per_m() const {
  return kMeanIsUncertain * (slips_m2_ + kPriorSlips_m2) / (observed_m_ + kPriorDistance_m);
}

LearntOdometryNoise OdometryNoiseLearner::learnt_noise() const {
  struct Model {
    double log_posterior;
    double along;
    double turn;
  };

  std::vector<Model> models;
  double best = -std::numeric_limits<double>::infinity();
  for (std::size_t a = 0; a < kScales; ++a) {
    for (std::size_t t = 0; t < kScales; ++t) {
      const double apart = std::log(scale_at(a) / scale_at(t)) / kCoupling;
      const double log_posterior = along_.log_likelihood(a) + turn_.log_likelihood(t) -
                                   0.5 * squared(apart) - (a > 0 ? kPriorLogOdds : 0.0) -
                                   (t > 0 ? kPriorLogOdds : 0.0);
      models.push_back({log_posterior, scale_at(a), scale_at(t)});
      best = std::max(best, log_posterior);
    }
  }
  double sum = 0.0;
  double along2 = 0.0;
  double turn2 = 0.0;
  for (const Model& model : models) {
    const double posterior = std::exp(model.log_posterior - best);
    sum += posterior;
    along2 += posterior * squared(model.along);
    turn2 += posterior * squared(model.turn);
  }
  LearntOdometryNoise learnt{std::sqrt(along2 / sum), std::sqrt(turn2 / sum)};
  learnt.slip_m2_per_m = slip_m2_per_m();
  learnt.slip_m2 = (slips_m2_ + kPriorSlips_m2) / (slips_ + 1.0);
  learnt.slip_per_m = slips_m_ / (observed_m_ + kPriorDistance_m);
  return learnt;
}

}  // namespace waymark
