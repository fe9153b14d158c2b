// SPDX-License-Identifier: BSD-3-Clause
#include "slam/core/scan/observability.hpp"

#include "common/geometry/principal_axes.hpp"

#include <algorithm>
#include <cmath>

namespace waymark {
namespace {

constexpr int kNeighbours = 5;               // beams on each side to which the surface is fitted
constexpr double kSurfaceReach_m = 0.5;      // neighbours further away belong to other surfaces
constexpr double kMaxThicknessRatio = 0.15;  // of the standard deviations across and along a line
constexpr int kMinPoints = 5;
// Noise turns fitted normals by some degrees: sin^2 of these angles of the strong direction's
// information leaks into the weak direction, where less than this share is not significant.
constexpr double kDegenerateShare = 0.03;

}  // namespace

std::optional<Eigen::Vector2d> surface_normal(std::span<const AnnotatedBeam> beams, int beam) {
  const auto count = static_cast<int>(beams.size());
  const Eigen::Vector2d& centre = beams[static_cast<std::size_t>(beam)].beam.end_in_base;
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  Eigen::Matrix2d squares = Eigen::Matrix2d::Zero();
  int points = 0;
  for (int step = -kNeighbours; step <= kNeighbours; ++step) {
    const int wrapped = ((beam + step) % count + count) % count;
    const Eigen::Vector2d offset =
        beams[static_cast<std::size_t>(wrapped)].beam.end_in_base - centre;
    if (offset.norm() > kSurfaceReach_m) continue;
    sum += offset;
    squares += offset * offset.transpose();
    ++points;
  }
  if (points < kMinPoints) return std::nullopt;
  const Eigen::Vector2d mean = sum / points;
  const Eigen::Matrix2d scatter = squares / points - mean * mean.transpose();
  // Eigenvalues and the direction of the smaller one, in closed form.
  const double half_trace = 0.5 * scatter.trace();
  const double half_difference = 0.5 * (scatter(0, 0) - scatter(1, 1));
  const double radius = std::hypot(half_difference, scatter(0, 1));
  if (radius <= 0.0 || std::sqrt(std::max(0.0, half_trace - radius)) >
                           kMaxThicknessRatio * std::sqrt(half_trace + radius)) {
    return std::nullopt;
  }
  const Eigen::Vector2d normal = half_difference > 0.0
                                     ? Eigen::Vector2d{-scatter(0, 1), half_difference + radius}
                                     : Eigen::Vector2d{half_difference - radius, scatter(0, 1)};
  return normal.normalized();
}

Observability observability_of(std::span<const AnnotatedBeam> beams, const Se2& map_from_base,
                               double range_sigma_m) {
  Observability result;
  const Eigen::Matrix2d turn = map_from_base.rotation();
  for (std::size_t i = 0; i < beams.size(); ++i) {
    const auto normal_in_base = surface_normal(beams, static_cast<int>(i));
    if (!normal_in_base) continue;
    const Eigen::Vector2d& end = beams[i].beam.end_in_base;
    const Eigen::Vector2d normal = turn * *normal_in_base;
    // d(x, y)/d(theta) = (-y, x) in the base frame.
    const Eigen::Vector3d row{normal.x(), normal.y(),
                              normal_in_base->dot(Eigen::Vector2d{-end.y(), end.x()})};
    result.information += row * row.transpose() / (range_sigma_m * range_sigma_m);
  }
  const PrincipalAxes axes = principal_axes(result.information.topLeftCorner<2, 2>());
  result.weak_direction = axes.directions.col(0);
  result.weak_information = axes.values[0];
  result.is_degenerate = axes.values[0] <= kDegenerateShare * axes.values[1];
  return result;
}

}  // namespace waymark
