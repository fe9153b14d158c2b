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
                            const Se2& map_from_base, const Eigen::Matrix3d& uncertainty,
                            const SurfaceMatchingConfig& config) {
  const Eigen::Matrix2d turn = map_from_base.rotation();
  SurfaceMatch match;
  match.beams = static_cast<int>(beams.size());
  for (const AnnotatedBeam& annotated : beams) {
    const Beam& beam = annotated.beam;
    const Eigen::Vector2d lever = turn * beam.end_in_base;
    const Eigen::Vector2d end = lever + map_from_base.translation();
    const double spread_m2 =
        std::max(uncertainty(0, 0), uncertainty(1, 1)) + uncertainty(2, 2) * lever.squaredNorm();
    const auto surface = map.near(end, 2.0 * std::sqrt(spread_m2));
    if (!surface) continue;
    const Eigen::Vector2d& normal = surface->normal_in_map;
    const Eigen::Vector2d along{-normal.y(), normal.x()};
    const Eigen::Vector2d ray = turn * (beam.end_in_base - beam.start_in_base) / beam.range_m;
    const Eigen::Vector3d row{normal.x(), normal.y(),
                              normal.x() * -lever.y() + normal.y() * lever.x()};
    const Eigen::Vector3d along_row{along.x(), along.y(),
                                    along.x() * -lever.y() + along.y() * lever.x()};
    const double variance_m2 = squared(config.range_sigma_m * normal.dot(ray)) +
                               squared(config.surface_sigma_m) +
                               surface->across_m2 / surface->count;
    const double residual_m = normal.dot(end - surface->point_in_map);
    const double error = squared(residual_m) / (variance_m2 + row.dot(uncertainty * row));
    // Geman-McClure: quadratic near zero, constant far away.
    const double knee = squared(config.outlier_sigmas);
    const double trust = knee / (knee + error);
    const double weight = config.information_share * squared(trust) / variance_m2;
    // A normal that is turned by its noise seems to tell what lies along the surface: the square of
    // that is taken out again, on average.
    match.pose.information.noalias() +=
        weight * (row * row.transpose() - surface->normal_rad2 * along_row * along_row.transpose());
    match.pose.gradient.noalias() += weight * residual_m * row;
    match.pose.cost += 0.5 * config.information_share * error * trust;
    match.mapped += 1.0;
    match.agreeing += trust;
  }
  keep_observed(config.weak_share, match.pose);
  return match;
}

}  // namespace waymark
