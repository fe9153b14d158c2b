// SPDX-License-Identifier: BSD-3-Clause
#include "slam/core/matching/range_scale.hpp"

#include <Eigen/Cholesky>
#include <Eigen/LU>

#include <cmath>

namespace waymark {
namespace {

constexpr int kSteps = 4;
constexpr double kMinMapped = 0.1;  // share of the beams
constexpr double kRight = 0.01;     // LiDARs are as good as that or better
constexpr double kWrong = 0.02;
constexpr double kTellingSigmas = 20.0;  // beams err together, and so do walls
constexpr double kMinFitting = 0.95;     // mostly it is 0.965
constexpr double kReach_m = 0.05;        // of the search for walls, and ...
constexpr double kReach = 0.05;          // ... share of the range
constexpr double kKnee = 5.0;        // [sigma] a beam this far from its wall counts a quarter, ...
constexpr double kFirstKnee = 30.0;  // ... and at first

double squared(double x) {
  return x * x;
}

/// Of (x, y, theta; map frame) and the scale.
struct Fit {
  Eigen::Matrix4d information{Eigen::Matrix4d::Zero()};
  Eigen::Vector4d gradient{Eigen::Vector4d::Zero()};
  double mapped{0.0};
  double fitting{0.0};
};

/// @param knee_sigmas  of the trust in a beam.
Fit fit_at(std::span<const AnnotatedBeam> beams, SurfaceFinder& map, const Se2& map_from_base,
           double scale, double knee_sigmas, const SurfaceMatchingConfig& config) {
  Fit fit;
  const Eigen::Matrix2d turn = map_from_base.rotation();
  for (std::size_t i = 0; i < beams.size(); ++i) {
    const Beam& beam = beams[i].beam;
    const Eigen::Vector2d ray = turn * (beam.end_in_base - beam.start_in_base);
    const Eigen::Vector2d lever = turn * beam.start_in_base + (1.0 - scale) * ray;
    const Eigen::Vector2d end = map_from_base.translation() + lever;
    const auto& wall = map.near(i, end, kReach_m + kReach * beam.range_m);
    if (!wall || !wall->is_line) continue;
    const Eigen::Vector2d& normal = wall->normal_in_map;
    const double across = normal.dot(ray);
    const double residual_m = normal.dot(end - wall->point_in_map);
    const double variance_m2 = squared(config.range_sigma_m * across / beam.range_m) +
                               squared(config.surface_sigma_m) + wall->across_m2 / wall->count;
    const double error = squared(residual_m) / variance_m2;
    const double trust = squared(knee_sigmas) / (squared(knee_sigmas) + error);
    const Eigen::Vector4d row{normal.x(), normal.y(),
                              normal.y() * lever.x() - normal.x() * lever.y(), -across};
    const double weight = squared(trust) / variance_m2;
    fit.information += weight * row * row.transpose();
    fit.gradient += weight * residual_m * row;
    fit.mapped += 1.0;
    fit.fitting += trust;
  }
  return fit;
}

}  // namespace

bool RangeScale::is_wrong() const {
  return std::abs(share) > kWrong && std::abs(share) > kTellingSigmas * sigma &&
         fitting > kMinFitting;
}

bool RangeScale::is_right() const {
  return std::abs(share) < kRight;
}

std::optional<RangeScale> range_scale(std::span<const AnnotatedBeam> beams, SurfaceFinder& map,
                                      const Se2& map_from_base, const Eigen::Matrix3d& uncertainty,
                                      const SurfaceMatchingConfig& config) {
  if (beams.empty()) return std::nullopt;
  Eigen::Matrix4d prior = Eigen::Matrix4d::Zero();
  prior.topLeftCorner<3, 3>() = uncertainty.inverse();
  Eigen::Vector4d found = Eigen::Vector4d::Zero();
  const auto fit_there = [&](double knee_sigmas) {
    return fit_at(beams, map, deviated(map_from_base, found.head<3>()), found[3], knee_sigmas,
                  config);
  };
  Fit fit;
  for (int step = 0; step < kSteps; ++step) {
    fit = fit_there(step == 0 ? kFirstKnee : kKnee);
    if (fit.mapped < kMinMapped * static_cast<double>(beams.size())) return std::nullopt;
    found -= (prior + fit.information).ldlt().solve(prior * found + fit.gradient);
  }
  fit = fit_there(kKnee);
  const Eigen::Matrix4d covariance = (prior + fit.information).inverse();
  return RangeScale{found[3], std::sqrt(covariance(3, 3)), fit.fitting / fit.mapped};
}

}  // namespace waymark
