// SPDX-License-Identifier: BSD-3-Clause
#include "slam/core/registration/range_scale.hpp"

#include "common/geometry/information.hpp"
#include "common/geometry/squared.hpp"

#include <Eigen/LU>

#include <algorithm>
#include <cmath>

namespace waymark {
namespace {

constexpr int kScaleSteps = 8;          // of Gauss-Newton
constexpr double kScaleKernel_m = 0.1;  // width of the robust kernel
constexpr double kScalePrior = 0.2;     // standard deviation of an error, and the largest one

constexpr double kEqualErrors = 0.01;  // largest difference between equal errors

using Vector4 = Eigen::Vector4d;

struct ScaleEquations {
  Eigen::Matrix4d information{Eigen::Matrix4d::Zero()};
  Vector4 gradient{Vector4::Zero()};
};

/// Normal equations for (x, y, theta, RangeScale::error), linearised at a pose and an error.
ScaleEquations scale_equations(std::span<const Eigen::Vector2d> points,
                               const Eigen::Vector2d& origin, const NdtMap& map, const Se2& pose,
                               double error, double point_variance_m2) {
  ScaleEquations sum;
  const Eigen::Matrix2d rotation = pose.rotation();
  for (const Eigen::Vector2d& measured : points) {
    const Eigen::Vector2d ray = measured - origin;
    const Eigen::Vector2d lever = rotation * (origin + ray / (1.0 + error));
    const Eigen::Vector2d there = lever + pose.translation();
    const NdtCell* cell = map.at(there, point_variance_m2);
    if (cell == nullptr || !cell->is_line) continue;
    const Eigen::Vector2d& normal = cell->normal;
    const double off_m = normal.dot(there - cell->mean);
    const double robust =
        squared(squared(kScaleKernel_m) / (squared(kScaleKernel_m) + squared(off_m)));
    const double weight = robust / (cell->across_m2 + point_variance_m2);
    const Vector4 jacobian{normal.x(), normal.y(),
                           normal.dot(Eigen::Vector2d{-lever.y(), lever.x()}),
                           -normal.dot(rotation * ray) / squared(1.0 + error)};
    sum.information += weight * jacobian * jacobian.transpose();
    sum.gradient += weight * off_m * jacobian;
  }
  return sum;
}

}  // namespace

RangeScale fit_range_scale(std::span<const Eigen::Vector2d> points_in_base,
                           const Eigen::Vector2d& origin_in_base, const NdtMap& map,
                           const Se2& guess, const Eigen::Matrix3d& guess_covariance,
                           const RangeNoise& noise) {
  Eigen::Matrix4d prior = Eigen::Matrix4d::Zero();
  prior.topLeftCorner<3, 3>() = guess_covariance.inverse();
  prior(3, 3) = 1.0 / squared(kScalePrior);
  Se2 pose = guess;
  RangeScale scale;
  for (int i = 0; i < kScaleSteps; ++i) {
    const ScaleEquations seen = scale_equations(points_in_base, origin_in_base, map, pose,
                                                scale.error, noise.variance_m2());
    Vector4 off;
    off << pose_difference(pose, guess), scale.error;
    const Eigen::Matrix4d covariance = (seen.information + prior).inverse();
    const Vector4 step = -covariance * (seen.gradient + prior * off);
    pose = moved_by(pose, step.head<3>());
    scale.error = std::clamp(scale.error + step[3], -kScalePrior, kScalePrior);
    scale.sigma = std::sqrt(covariance(3, 3));
  }
  return scale;
}

void RangeScaleMonitor::note_unscaled(const Points& points_in_base, const Se2& map_from_base) {
  unscaled_in_base_ = points_in_base;
  map_from_unscaled_ = map_from_base;
  error_.reset();
}

bool RangeScaleMonitor::try_accept(double error, const Points& points_in_base,
                                   const Eigen::Vector2d& origin_in_base, const Se2& map_from_base,
                                   const Eigen::Matrix3d& covariance, const RangeNoise& noise) {
  const auto agrees = [error](double other) {
    return std::abs(error - other) < kEqualErrors;
  };
  if (!error_ || !agrees(*error_)) {
    NdtMap last{cell_spacing_m_};
    for (const Eigen::Vector2d& point : unscaled_in_base_)
      last.add(point, kNoKeyframe);
    const Se2 last_from_map = map_from_unscaled_.inverse();
    const RangeScale since_last =
        fit_range_scale(points_in_base, origin_in_base, last, last_from_map * map_from_base,
                        in_axes(last_from_map.rotation(), covariance), noise);
    if (!agrees(since_last.error)) return false;
  }
  error_ = error;
  return true;
}

}  // namespace waymark
