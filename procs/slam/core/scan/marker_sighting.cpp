// SPDX-License-Identifier: BSD-3-Clause
#include "slam/core/scan/marker_sighting.hpp"

#include <Eigen/Eigenvalues>

#include <cmath>

namespace waymark {
namespace {

constexpr double kMaxTilt_rad = radians(30.0);
constexpr double kMaxRange_m = 100.0;  // no camera decodes a marker from there
constexpr double kMaxVariance = 1e6;   // trace of the covariance; more is no measurement
constexpr double kRounding = 1e-9;     // of a covariance, share of its trace

/// Symmetric and positive semidefinite, up to rounding.
bool is_covariance(const Eigen::Matrix3d& matrix) {
  const double trace = matrix.trace();
  if (!(trace >= 0.0 && trace < kMaxVariance)) return false;
  if (!((matrix - matrix.transpose()).cwiseAbs().maxCoeff() <= kRounding * trace)) return false;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes{matrix, Eigen::EigenvaluesOnly};
  return axes.eigenvalues()[0] >= -kRounding * trace;
}

}  // namespace

Eigen::Matrix3d planar_covariance(const Eigen::Matrix<double, 6, 6>& covariance) {
  constexpr int kPlanar[]{0, 1, 5};  // x, y, rotation about z
  Eigen::Matrix3d planar;
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) {
      planar(row, column) = covariance(kPlanar[row], kPlanar[column]);
    }
  }
  return planar;
}

std::optional<MarkerSighting> sight_marker(const MarkerDetection& detection, Timestamp time,
                                           const Se2& scan_base_from_frame_base, double size_m) {
  const Eigen::Vector3d facing = detection.base_from_marker.linear().col(2);
  if (std::abs(facing.z()) > std::sin(kMaxTilt_rad)) return std::nullopt;
  if (!(detection.base_from_marker.translation().norm() < kMaxRange_m)) return std::nullopt;
  const Eigen::Matrix3d covariance = planar_covariance(detection.covariance_in_base);
  if (!is_covariance(covariance)) return std::nullopt;

  const Se2 frame_base_from_marker{
      Eigen::Vector2d{detection.base_from_marker.translation().head<2>()},
      std::atan2(facing.y(), facing.x())};
  return MarkerSighting{detection.id,
                        time,
                        scan_base_from_frame_base * frame_base_from_marker,
                        in_axes(scan_base_from_frame_base.rotation(), covariance),
                        size_m,
                        scan_base_from_frame_base.translation().norm(),
                        std::abs(scan_base_from_frame_base.theta())};
}

}  // namespace waymark
