// SPDX-License-Identifier: BSD-3-Clause
// What each measurement says, in standard deviations, in the form that Ceres differentiates.
#pragma once

#include "batch_limit/association.hpp"
#include "slam/core/landmark/marker_measurement.hpp"
#include "slam/core/motion/odometry_errors.hpp"

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
    const Eigen::Matrix<T, kOdometryTerms, 1> change =
        Eigen::Map<const Eigen::Matrix<T, kOdometryTerms, 1>>{errors} - about.cast<T>();
    const Se2& measured = motion.start_from_end;
    const Vector3<T> expected = Vector3<T>{T{measured.x()}, T{measured.y()}, T{measured.theta()}} +
                                motion.jacobian_calibration.cast<T>() * change;
    Vector3<T> residual = relative(from, to) - expected;
    residual.z() = wrapped(residual.z());
    Eigen::Map<Vector3<T>>{out} = whiten.cast<T>() * residual;
    return true;
  }
};

/// One straight piece of a wall between two knots, map frame.
struct WallPiece {
  Eigen::Vector2d begin;  ///< where its first knot would be without an offset
  Eigen::Vector2d along;  ///< the wall's line
  Eigen::Vector2d normal;
  double normal_rad;
  double length_m;

  WallPiece(const Wall& wall, int piece, double piece_m)
      : begin{wall.anchor + piece_m * (piece - 0.5) * wall.along()},
        along{wall.along()},
        normal{wall.normal()},
        normal_rad{wall.normal_rad},
        length_m{piece_m} {}

  /// How far `place` lies before the piece [m], along the normal of the wall's line; the offsets
  /// are its two knots'.
  template <class T>
  T before(const Vector2<T>& place, const T& begin_m, const T& end_m) const {
    const Vector2<T> from_begin = place - begin.cast<T>();
    const T share = along.cast<T>().dot(from_begin) / length_m;
    return normal.cast<T>().dot(from_begin) - (begin_m + share * (end_m - begin_m));
  }

  /// The direction of the piece's own normal.
  template <class T>
  T direction_rad(const T& begin_m, const T& end_m) const {
    return normal_rad - (end_m - begin_m) / length_m;
  }
};

struct WallResidual {
  LineOfScan line;  ///< of beams that ended on the piece
  WallPiece piece;

  template <class T>
  bool operator()(const T* pose, const T* begin_m, const T* end_m, T* out) const {
    const Vector2<T> middle =
        turned<T>(line.middle.cast<T>(), pose[2]) + Vector2<T>{pose[0], pose[1]};
    out[0] = piece.before(middle, *begin_m, *end_m) / line.sigma_m;
    out[1] = wrapped<T>(pose[2] + line.normal_rad - piece.direction_rad(*begin_m, *end_m)) /
             line.sigma_rad;
    return true;
  }
};

/// Not held to its wall. What the camera's errors do to it is taken where the marker is, not where
/// it was measured (MarkerMeasurement::jacobian_calibration_at).
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
  WallPiece piece;
  double sigma_m;
  double sigma_rad;

  template <class T>
  bool operator()(const T* marker, const T* begin_m, const T* end_m, const T* standoff,
                  T* out) const {
    const Vector2<T> place{marker[0], marker[1]};
    out[0] = (piece.before(place, *begin_m, *end_m) - *standoff) / sigma_m;
    out[1] = wrapped<T>(marker[2] - piece.direction_rad(*begin_m, *end_m)) / sigma_rad;
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
