// SPDX-License-Identifier: BSD-3-Clause
// Resampling of particles.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace waymark {

/// Systematic (low-variance) resampling: particle i appears floor or ceil of N w_i times, N w_i on
/// average over `offset`. Source: Thrun, Burgard, Fox (2005), table 4.4.
/// @param weights  normalised.
/// @param offset   uniform in [0, 1).
/// @return weights.size() indices, ascending.
std::vector<std::size_t> resample_systematically(std::span<const double> weights, double offset);

/// 1 / sum of squared normalised weights: from 1 (one particle has it all) to N.
double effective_number(std::span<const double> weights);

}  // namespace waymark
