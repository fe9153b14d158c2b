// SPDX-License-Identifier: BSD-3-Clause
// Particles of a filter: states with log weights.
#pragma once

#include "common/geometry/se2.hpp"
#include "common/random/random.hpp"
#include "slam/core/resampling/systematic.hpp"

#include <Eigen/Core>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <vector>

namespace waymark {

/// @tparam State  one hypothesis: a pose, or a pose with a map. Copied on resampling.
template <class State>
class ParticleSet {
 public:
  ParticleSet(std::size_t count, const State& state)
      : states_(count, state),
        log_weights_(count, 0.0),
        weights_(count, 1.0 / static_cast<double>(count)) {
    assert(count > 0);
  }

  std::size_t size() const { return states_.size(); }

  State& state(std::size_t particle) { return states_[particle]; }

  const State& state(std::size_t particle) const { return states_[particle]; }

  /// Multiplies a particle's weight; call normalise() when all are done. -inf: weight 0.
  void add_log_weight(std::size_t particle, double log_weight) {
    log_weights_[particle] += log_weight;
  }

  /// Shifts the log weights to a maximum of 0 and computes the weights; equal if all are 0.
  void normalise() {
    const double highest = *std::max_element(log_weights_.begin(), log_weights_.end());
    double sum = 0.0;
    for (std::size_t i = 0; i < size(); ++i) {
      log_weights_[i] = std::isfinite(highest) ? log_weights_[i] - highest : 0.0;
      weights_[i] = std::exp(log_weights_[i]);
      sum += weights_[i];
    }
    for (double& weight : weights_)
      weight /= sum;
  }

  /// Normalised; as of the last normalise() or resample_if_needed().
  const std::vector<double>& weights() const { return weights_; }

  double effective_number() const { return waymark::effective_number(weights_); }

  /// The particle with the highest weight; the first of equals.
  std::size_t best() const {
    return static_cast<std::size_t>(std::max_element(log_weights_.begin(), log_weights_.end()) -
                                    log_weights_.begin());
  }

  /// Resamples if fewer than `threshold` (share of all) are effective, after which all weights are
  /// equal. Returns the parent of each particle, empty without resampling.
  std::vector<std::size_t> resample_if_needed(double threshold, Random& random) {
    if (effective_number() >= threshold * static_cast<double>(size())) return {};
    std::vector<std::size_t> parents = resample_systematically(weights_, random.uniform());
    std::vector<State> next;
    next.reserve(size());
    for (const std::size_t parent : parents)
      next.push_back(states_[parent]);
    states_ = std::move(next);
    std::fill(log_weights_.begin(), log_weights_.end(), 0.0);
    std::fill(weights_.begin(), weights_.end(), 1.0 / static_cast<double>(size()));
    return parents;
  }

 private:
  std::vector<State> states_;
  std::vector<double> log_weights_;
  std::vector<double> weights_;
};

/// Weighted mean of the particles' poses; headings are averaged on the circle.
/// @tparam State  has a member map_from_base.
template <class State>
Se2 mean_pose(const ParticleSet<State>& particles) {
  Eigen::Vector2d translation = Eigen::Vector2d::Zero();
  Eigen::Vector2d heading = Eigen::Vector2d::Zero();
  for (std::size_t i = 0; i < particles.size(); ++i) {
    const Se2& pose = particles.state(i).map_from_base;
    const double weight = particles.weights()[i];
    translation += weight * pose.translation();
    heading += weight * Eigen::Vector2d{std::cos(pose.theta()), std::sin(pose.theta())};
  }
  return {translation, std::atan2(heading.y(), heading.x())};
}

/// Mean square of the particles' deviations from a pose, map frame. If the pose is not their mean,
/// the result includes the square of the difference, as an error of that pose.
/// @tparam State  has a member map_from_base.
template <class State>
Eigen::Matrix3d covariance_about(const Se2& map_from_base, const ParticleSet<State>& particles) {
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  for (std::size_t i = 0; i < particles.size(); ++i) {
    const Eigen::Vector3d deviation =
        pose_difference(particles.state(i).map_from_base, map_from_base);
    covariance += particles.weights()[i] * deviation * deviation.transpose();
  }
  return covariance;
}

}  // namespace waymark
