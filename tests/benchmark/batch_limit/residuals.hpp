// SPDX-License-Identifier: BSD-3-Clause
// What each measurement says, in standard deviations, in the form that Ceres differentiates.
#pragma once

#include "batch_limit/wall_lines.hpp"
#include "slam/core/belief/odometry_errors.hpp"
#include "slam/core/landmark/marker_measurement.hpp"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <ceres/ceres.h>

#include <array>
#include <numbers>

namespace waymark::benchmark {

template <class T>
T wrapped(const T& angle_rad) {
  constexpr double kTurn = 2.0 * std::numbers::pi;
  return angle_rad - kTurn * ceres::floor((angle_rad + std::numbers::pi) / kTurn);
}

template <class T>
using Vector2 = Eigen::Matrix<T, 2, 1>;
template <class T>
using Vector3 = Eigen::Matrix<T, 3, 1>;

template <class T>
Vector2<T> turned(const Vector2<T>& vector, const T& by_rad) {
  const T c = ceres::cos(by_rad);
  const T s = ceres::sin(by_rad);
  return {c * vector.x() - s * vector.y(), s * vector.x() + c * vector.y()};
}

/// (x, y, theta) of one pose in the frame of another; the angle is not wrapped.
template <class T>
Vector3<T> relative(const T* parent_from_one, const T* parent_from_other) {
  const Vector2<T> between{parent_from_other[0] - parent_from_one[0],
                           parent_from_other[1] - parent_from_one[1]};
  const Vector2<T> translation = turned<T>(between, -parent_from_one[2]);
  return {translation.x(), translation.y(), parent_from_other[2] - parent_from_one[2]};
}

/// Turns a residual with that covariance into one with unit covariance.
inline Eigen::Matrix3d whitening(const Eigen::Matrix3d& covariance) {
  return Eigen::LLT<Eigen::Matrix3d>{Eigen::Matrix3d{covariance.inverse()}}.matrixU();
}

struct MotionResidual {
  CorrectedMotion motion;
  OdometryErrors about;
  Eigen::Matrix3d whiten;

  template <class T>
  bool operator()(const T* from, const T* to, const T* errors, T* out) const {
    const Eigen::Matrix<T, kOdometryErrors, 1> change =
        Eigen::Map<const Eigen::Matrix<T, kOdometryErrors, 1>>{errors} - about.cast<T>();
    const Se2& measured = motion.start_from_end;
    const Vector3<T> expected = Vector3<T>{T{measured.x()}, T{measured.y()}, T{measured.theta()}} +
                                motion.by_errors.cast<T>() * change;
    Vector3<T> residual = relative(from, to) - expected;
    residual.z() = wrapped(residual.z());
    Eigen::Map<Vector3<T>>{out} = whiten.cast<T>() * residual;
    return true;
  }
};

struct WallResidual {
  LineOfScan line;
  Eigen::Vector2d anchor;

  template <class T>
  bool operator()(const T* pose, const T* wall, T* out) const {
    const Vector2<T> middle =
        turned<T>(line.middle.cast<T>(), pose[2]) + Vector2<T>{pose[0], pose[1]};
    const Vector2<T> normal{ceres::cos(wall[0]), ceres::sin(wall[0])};
    const Vector2<T> from_anchor = middle - anchor.cast<T>();
    out[0] = (normal.dot(from_anchor) - wall[1]) / line.sigma_m;
    out[1] = wrapped<T>(pose[2] + line.normal_rad - wall[0]) / line.sigma_rad;
    return true;
  }
};

/// Not held to its wall. What the camera's errors do to it is taken where the marker is, not where
/// it was measured (MarkerMeasurement::by_errors_at).
struct MarkerResidual {
  MarkerMeasurement measurement;
  Eigen::Matrix3d whiten;

  template <class T>
  bool operator()(const T* pose, const T* marker, const T* camera, T* out) const {
    const Se2& measured = measurement.base_from_marker;
    const Vector3<T> expected = relative(pose, marker);
    const Vector2<T> ray =
        expected.template head<2>() - measurement.base_from_camera.translation().cast<T>();
    const Vector2<T> ahead = measurement.base_from_camera.rotation().col(0).cast<T>();
    const Vector2<T> moved =
        camera[0] * Vector2<T>{ray.y(), -ray.x()} - camera[1] * ahead.dot(ray) * ahead;
    Vector3<T> residual = Vector3<T>{T{measured.x()}, T{measured.y()}, T{measured.theta()}} -
                          expected - Vector3<T>{moved.x(), moved.y(), -camera[0]};
    residual.z() = wrapped(residual.z());
    Eigen::Map<Vector3<T>>{out} = whiten.cast<T>() * residual;
    return true;
  }
};

/// A marker hangs on its wall, all of them equally far off it.
struct HangingResidual {
  Eigen::Vector2d anchor;
  double sigma_m;
  double sigma_rad;

  template <class T>
  bool operator()(const T* marker, const T* wall, const T* standoff, T* out) const {
    const Vector2<T> normal{ceres::cos(wall[0]), ceres::sin(wall[0])};
    const Vector2<T> from_anchor = Vector2<T>{marker[0], marker[1]} - anchor.cast<T>();
    out[0] = (normal.dot(from_anchor) - wall[1] - standoff[0]) / sigma_m;
    out[1] = wrapped<T>(marker[2] - wall[0]) / sigma_rad;
    return true;
  }
};

struct FocalResidual {
  FocalSighting focal;

  template <class T>
  bool operator()(const T* camera, T* out) const {
    out[0] = (focal.error - camera[1]) / focal.sigma;
    return true;
  }
};

/// Holds values near zero.
template <int kSize>
struct PriorResidual {
  std::array<double, kSize> sigmas;

  template <class T>
  bool operator()(const T* values, T* out) const {
    for (std::size_t i = 0; i < kSize; ++i)
      out[i] = values[i] / sigmas[i];
    return true;
  }
};

}  // namespace waymark::benchmark
