// SPDX-License-Identifier: BSD-3-Clause
// Particles of a filter: states with log weights.
#pragma once

#include "common/random/random.hpp"
#include "slam/core/resampling/systematic.hpp"

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

}  // namespace waymark
