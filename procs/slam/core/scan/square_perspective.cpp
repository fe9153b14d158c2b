// SPDX-License-Identifier: BSD-3-Clause
#include "slam/core/scan/square_perspective.hpp"

#include <cmath>

namespace waymark {
namespace {

constexpr double kMinDepth = 0.7;  // of the square's side; less is too frontal a view

/// A vertical edge of the square, in units of its side: right of the camera, and ahead of it in
/// focal lengths.
struct Edge {
  double right;
  double ahead;
  double ahead_sigma;
};

Edge edge_between(const Eigen::Vector2d& top, const Eigen::Vector2d& bottom, double corner_sigma) {
  const double height = bottom.y() - top.y();
  return {0.5 * (top.x() + bottom.x()) / height, 1.0 / height,
          std::sqrt(2.0) * corner_sigma / (height * height)};
}

}  // namespace

std::optional<FocalMeasurement> focal_error_of(const std::array<Eigen::Vector2d, 4>& corners,
                                               double corner_sigma) {
  const Edge left = edge_between(corners[0], corners[3], corner_sigma);
  const Edge right = edge_between(corners[1], corners[2], corner_sigma);
  const double depth2 = 1.0 - (right.right - left.right) * (right.right - left.right);
  const double seen_depth = std::abs(right.ahead - left.ahead);
  if (!(depth2 > kMinDepth * kMinDepth) || !(seen_depth > 0.0)) return std::nullopt;
  const double ratio = std::sqrt(depth2) / seen_depth;
  return FocalMeasurement{ratio - 1.0,
                          ratio * std::hypot(left.ahead_sigma, right.ahead_sigma) / seen_depth};
}

}  // namespace waymark
