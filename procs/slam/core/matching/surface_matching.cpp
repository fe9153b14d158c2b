// SPDX-License-Identifier: BSD-3-Clause
#include "slam/core/matching/surface_matching.hpp"

#include <Eigen/Eigenvalues>

namespace waymark {
namespace {

double squared(double x) {
  return x * x;
}

}  // namespace

void keep_observed(double weak_share, PoseInformation& pose) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> translation{
      Eigen::Matrix2d{pose.information.topLeftCorner<2, 2>()}};
  const double threshold = weak_share * translation.eigenvalues()[1];
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes{pose.information};
  Eigen::Matrix3d observed = Eigen::Matrix3d::Zero();
  for (int i = 0; i < 3; ++i) {
    if (axes.eigenvalues()[i] <= threshold) continue;
    const Eigen::Vector3d axis = axes.eigenvectors().col(i);
    observed += axis * axis.transpose();
  }
  pose.information = observed * pose.information * observed;
  pose.gradient = observed * pose.gradient;
}

SurfaceMatch match_surfaces(std::span<const AnnotatedBeam> beams, const SurfaceMap& map,
                            const Se2& map_from_base, const SurfaceMatchingConfig& config) {
  const Eigen::Matrix2d turn = map_from_base.rotation();
  SurfaceMatch match;
  match.beams = static_cast<int>(beams.size());
  for (const AnnotatedBeam& annotated : beams) {
    const Beam& beam = annotated.beam;
    const Eigen::Vector2d lever = turn * beam.end_in_base;
    const Eigen::Vector2d end = lever + map_from_base.translation();
    const auto surface = map.near(end);
    if (!surface) continue;
    const Eigen::Vector2d& normal = surface->normal_in_map;
    const Eigen::Vector2d ray = turn * (beam.end_in_base - beam.start_in_base) / beam.range_m;
    const double variance_m2 =
        squared(config.range_sigma_m * normal.dot(ray)) + squared(config.surface_sigma_m);
    const double residual_m = normal.dot(end - surface->point_in_map);
    const double error = squared(residual_m) / variance_m2;
    // Geman-McClure: quadratic near zero, constant far away.
    const double knee = squared(config.outlier_sigmas);
    const double trust = knee / (knee + error);
    const double weight = config.information_share * trust * trust / variance_m2;
    const Eigen::Vector3d row{normal.x(), normal.y(),
                              normal.x() * -lever.y() + normal.y() * lever.x()};
    match.pose.information.noalias() += weight * row * row.transpose();
    match.pose.gradient.noalias() += weight * residual_m * row;
    match.pose.cost += 0.5 * config.information_share * error * trust;
    match.mapped += 1.0;
    match.agreeing += trust;
  }
  keep_observed(config.weak_share, match.pose);
  return match;
}

}  // namespace waymark
