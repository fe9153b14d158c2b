// SPDX-License-Identifier: BSD-3-Clause
#include "slam/core/filter/centred_normals.hpp"

#include "slam/core/resampling/systematic.hpp"

#include <cmath>

namespace waymark {

std::vector<Eigen::Vector3d> centred_normals(std::span<const double> weights,
                                             const std::function<Random(std::size_t)>& random_of) {
  std::vector<Eigen::Vector3d> normals;
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < weights.size(); ++i) {
    Random random = random_of(i);
    normals.emplace_back(random.normal(), random.normal(), random.normal());
    mean += weights[i] * normals.back();
  }
  const double shrunk = 1.0 - 1.0 / effective_number(weights);
  if (shrunk < 0.5) return normals;
  for (Eigen::Vector3d& normal : normals)
    normal = (normal - mean) / std::sqrt(shrunk);
  return normals;
}

}  // namespace waymark
