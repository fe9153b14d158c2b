// SPDX-License-Identifier: BSD-3-Clause
#include "common/geometry/rigid_fit.hpp"

#include <cmath>

namespace waymark {

Se2 rigid_fit(const std::vector<PointPair>& pairs) {
  Eigen::Vector2d target_mean = Eigen::Vector2d::Zero();
  Eigen::Vector2d source_mean = Eigen::Vector2d::Zero();
  for (const PointPair& pair : pairs) {
    target_mean += pair.target / static_cast<double>(pairs.size());
    source_mean += pair.source / static_cast<double>(pairs.size());
  }
  double cosine = 0.0;
  double sine = 0.0;
  for (const PointPair& pair : pairs) {
    const Eigen::Vector2d source = pair.source - source_mean;
    const Eigen::Vector2d target = pair.target - target_mean;
    cosine += source.dot(target);
    sine += source.x() * target.y() - source.y() * target.x();
  }
  const Se2 turn{0.0, 0.0, std::atan2(sine, cosine)};
  return {target_mean - turn * source_mean, turn.theta()};
}

}  // namespace waymark
