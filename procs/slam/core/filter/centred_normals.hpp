// SPDX-License-Identifier: BSD-3-Clause
// What particles draw, without the noise that drawing adds to their mean.
#pragma once

#include "common/random/random.hpp"

#include <Eigen/Core>

#include <cstddef>
#include <functional>
#include <span>
#include <vector>

namespace waymark {

/// Standard normal samples, one for each weight, whose weighted mean is exactly zero and whose
/// spread is kept: the mean of the particles then follows the mean of the proposals. They stay as
/// drawn when one particle has nearly all the weight.
/// @param weights  normalised.
/// @param random_of  random numbers of a particle.
std::vector<Eigen::Vector3d> centred_normals(std::span<const double> weights,
                                             const std::function<Random(std::size_t)>& random_of);

}  // namespace waymark
