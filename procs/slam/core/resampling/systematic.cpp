// SPDX-License-Identifier: BSD-3-Clause
#include "slam/core/resampling/systematic.hpp"

namespace waymark {

std::vector<std::size_t> resample_systematically(std::span<const double> weights, double offset) {
  const auto count = static_cast<double>(weights.size());
  std::vector<std::size_t> survivors;
  survivors.reserve(weights.size());
  double cumulated = 0.0;
  for (std::size_t i = 0; i < weights.size(); ++i) {
    cumulated += weights[i];
    while (survivors.size() < weights.size() &&
           (static_cast<double>(survivors.size()) + offset) / count < cumulated) {
      survivors.push_back(i);
    }
  }
  // Rounding may leave the sum slightly below one.
  while (survivors.size() < weights.size()) {
    survivors.push_back(weights.size() - 1);
  }
  return survivors;
}

double effective_number(std::span<const double> weights) {
  double sum_of_squares = 0.0;
  for (const double weight : weights)
    sum_of_squares += weight * weight;
  return 1.0 / sum_of_squares;
}

}  // namespace waymark
