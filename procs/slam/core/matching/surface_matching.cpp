// SPDX-License-Identifier: BSD-3-Clause
#include "slam/core/matching/surface_matching.hpp"

#include "slam/core/scan/observability.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/QR>

#include <algorithm>

namespace waymark {
namespace {

double squared(double x) {
  return x * x;
}

/// What a beam gains by hitting what is mapped: beams that hit nothing known cost nothing, so
/// without it a particle that has left its map would be the most likely one. 1 is the mean error.
constexpr double kExplained = 2.0;
constexpr double kClumpKnee = 3.0;  // [sigma] a beam this far from its clump counts a quarter
// A clump counts half when the pose is less uncertain than the clump by this factor (variances),
// and this share when it is certain.
constexpr double kClumpGuides = 30.0;
constexpr double kClumpShare = 0.1;
// How far what moves with a robot along a wall may deviate from the wall; more is something else.
constexpr double kMaxSlant = 0.03;
constexpr double kMaxTurn_rad_per_m = 0.01;

/// The end of a beam, with how it moves with the pose (x, y, theta; map frame).
struct BeamEnd {
  Eigen::Vector2d end;
  Eigen::Vector2d lever;  ///< from the base
  Eigen::Vector2d ray;    ///< unit

  Eigen::Vector3d moved_along(const Eigen::Vector2d& direction) const {
    return {direction.x(), direction.y(), direction.x() * -lever.y() + direction.y() * lever.x()};
  }
};

/// Geman-McClure: 1 near zero, so that the cost is quadratic, and falling, so that it is constant
/// far away.
double trust_in(double error, double knee_sigmas) {
  return squared(knee_sigmas) / (squared(knee_sigmas) + error);
}

/// How often an error counts: for where the pose is, and for how likely the scan is.
struct Weight {
  double information{1.0};
  double evidence{1.0};
};

/// Adds "it lies off by `residual_m`".
/// @return how far it is trusted.
double add_distance(const Eigen::Vector3d& row, double residual_m, double variance_m2,
                    const Weight& weight, double knee_sigmas, const Eigen::Matrix3d& uncertainty,
                    PoseInformation& pose) {
  const double error = squared(residual_m) / (variance_m2 + row.dot(uncertainty * row));
  const double trust = trust_in(error, knee_sigmas);
  const double information = weight.information * squared(trust) / variance_m2;
  pose.information.noalias() += information * row * row.transpose();
  pose.gradient.noalias() += information * residual_m * row;
  pose.cost += 0.5 * weight.evidence * (error * trust - kExplained);
  return trust;
}

double add_line(const BeamEnd& hit, const Surface& line, const Eigen::Matrix3d& uncertainty,
                const SurfaceMatchingConfig& config, PoseInformation& pose) {
  const Eigen::Vector2d& normal = line.normal_in_map;
  const Eigen::Vector3d along = hit.moved_along({-normal.y(), normal.x()});
  const double variance_m2 = squared(config.range_sigma_m * normal.dot(hit.ray)) +
                             squared(config.surface_sigma_m) + line.across_m2 / line.count;
  const double trust =
      add_distance(hit.moved_along(normal), normal.dot(hit.end - line.point_in_map), variance_m2,
                   {config.information_share, config.information_share}, config.outlier_sigmas,
                   uncertainty, pose);
  // A normal that is turned by its noise seems to tell what lies along the surface: the square of
  // that is taken out again, on average.
  pose.information.noalias() -= config.information_share * squared(trust) / variance_m2 *
                                line.normal_rad2 * along * along.transpose();
  return trust;
}

/// The beam may have hit any of the clump's points, so their scatter is its uncertainty. Beams that
/// hit one clump err alike, and so do their successors that its points are made of: a clump guides
/// a pose that is uncertain, and says little about one that is known to a fraction of it.
void add_clump(const BeamEnd& hit, const Surface& clump, const Eigen::Matrix3d& uncertainty,
               const SurfaceMatchingConfig& config, PoseInformation& pose) {
  const Eigen::Vector2d& normal = clump.normal_in_map;
  const Eigen::Vector2d away = hit.end - clump.point_in_map;
  const double range_m2 = squared(config.range_sigma_m);
  const auto add = [&](const Eigen::Vector2d& axis, double variance_m2) {
    const Eigen::Vector3d row = hit.moved_along(axis);
    const double uncertain = kClumpGuides * row.dot(uncertainty * row);
    const double share = kClumpShare + (1.0 - kClumpShare) * uncertain / (uncertain + variance_m2);
    add_distance(row, axis.dot(away), variance_m2,
                 {config.clump_weight * share, config.clump_weight}, kClumpKnee, uncertainty, pose);
  };
  add(normal, clump.across_m2 + range_m2);
  add({-normal.y(), normal.x()}, clump.along_m2 + range_m2);
}

using TranslationAxes = Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d>;

TranslationAxes translation_axes(const PoseInformation& pose) {
  return TranslationAxes{Eigen::Matrix2d{pose.information.topLeftCorner<2, 2>()}};
}

void remove_direction(const Eigen::Vector2d& direction, PoseInformation& pose) {
  const Eigen::Matrix3d others = without(direction);
  pose.information = others * pose.information * others;
  pose.gradient = others * pose.gradient;
}

}  // namespace

void remove_weak_direction(const Eigen::Matrix3d& open, PoseInformation& pose) {
  const Eigen::Vector2d weak = translation_axes(pose).eigenvectors().col(0);
  const Eigen::Vector3d along{weak.x(), weak.y(), 0.0};
  const Eigen::Vector3d across{-weak.y(), weak.x(), 0.0};
  const Eigen::Vector3d with_along = open * along;
  const double variance = along.dot(with_along);
  Eigen::Vector3d moved = along;
  if (variance > 0.0) {
    moved += std::clamp(across.dot(with_along) / variance, -kMaxSlant, kMaxSlant) * across;
    moved.z() = std::clamp(with_along.z() / variance, -kMaxTurn_rad_per_m, kMaxTurn_rad_per_m);
  }
  const Eigen::Matrix3d others = Eigen::Matrix3d::Identity() - moved * along.transpose();
  pose.information = (others.transpose() * pose.information * others).eval();
  pose.gradient = (others.transpose() * pose.gradient).eval();
}

void keep_observed(double weak_share, PoseInformation& pose) {
  const TranslationAxes translation = translation_axes(pose);
  const double threshold = weak_share * translation.eigenvalues()[1];
  if (translation.eigenvalues()[0] <= threshold)
    remove_direction(translation.eigenvectors().col(0), pose);
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

Eigen::Matrix3d noise_of_walls(std::span<const AnnotatedBeam> beams,
                               const SurfaceMatchingConfig& config) {
  PoseInformation told;
  for (std::size_t i = 0; i < beams.size(); ++i) {
    const auto normal = surface_normal(beams, static_cast<int>(i));
    if (!normal) continue;
    const Beam& beam = beams[i].beam;
    const BeamEnd hit{beam.end_in_base, beam.end_in_base,
                      (beam.end_in_base - beam.start_in_base) / beam.range_m};
    const Eigen::Vector3d row = hit.moved_along(*normal);
    told.information +=
        row * row.transpose() /
        (squared(config.range_sigma_m * normal->dot(hit.ray)) + squared(config.surface_sigma_m));
  }
  keep_observed(config.weak_share, told);
  return told.information.completeOrthogonalDecomposition().pseudoInverse();
}

SurfaceMatch match_surfaces(std::span<const AnnotatedBeam> beams, SurfaceFinder& map,
                            const Se2& map_from_base, const Eigen::Matrix3d& uncertainty,
                            const SurfaceMatchingConfig& config) {
  const Eigen::Matrix2d turn = map_from_base.rotation();
  SurfaceMatch match;
  match.beams = static_cast<int>(beams.size());
  for (std::size_t i = 0; i < beams.size(); ++i) {
    const Beam& beam = beams[i].beam;
    const Eigen::Vector2d lever = turn * beam.end_in_base;
    const BeamEnd hit{lever + map_from_base.translation(), lever,
                      turn * (beam.end_in_base - beam.start_in_base) / beam.range_m};
    const double spread_m2 =
        std::max(uncertainty(0, 0), uncertainty(1, 1)) + uncertainty(2, 2) * lever.squaredNorm();
    const auto& surface = map.near(i, hit.end, 2.0 * std::sqrt(spread_m2));
    if (!surface) continue;
    if (surface->is_line) {
      match.mapped += 1.0;
      match.agreeing += add_line(hit, *surface, uncertainty, config, match.pose);
    } else if (config.clump_weight > 0.0) {
      add_clump(hit, *surface, uncertainty, config, match.pose);
    }
  }
  keep_observed(config.weak_share, match.pose);
  return match;
}

}  // namespace waymark
