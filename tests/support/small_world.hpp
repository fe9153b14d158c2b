// SPDX-License-Identifier: BSD-3-Clause
// Small inputs for tests of the estimators' parts.
#pragma once

#include "common/geometry/angle.hpp"
#include "common/random/random.hpp"
#include "slam/core/landmark/marker_measurement.hpp"
#include "slam/core/scan/annotated_scan.hpp"

#include <Eigen/Core>

#include <cmath>
#include <vector>

namespace waymark::test {

/// Covariance of (x, y, yaw) from standard deviations.
inline Eigen::Matrix3d diagonal(double x, double y, double yaw) {
  return Eigen::Vector3d{x * x, y * y, yaw * yaw}.asDiagonal();
}

/// A measurement with sigmas of a centimetre along the view, half of it across, and 20 mrad.
inline MarkerMeasurement measurement_of(const Se2& base_from_marker, int id = 7) {
  MarkerMeasurement measurement;
  measurement.id = id;
  measurement.base_from_marker = base_from_marker;
  measurement.covariance = diagonal(0.01, 0.005, 0.02);
  return measurement;
}

/// Scan from the middle of a corridor 2 m wide, with walls on both sides.
inline std::vector<AnnotatedBeam> corridor_beams(double noise_m, Random& random) {
  std::vector<AnnotatedBeam> beams;
  for (int i = 0; i < 360; ++i) {
    const double angle_rad = radians(i);
    const double range_m = 1.0 / std::abs(std::sin(angle_rad)) + random.normal(0.0, noise_m);
    if (!(range_m < 3.5)) continue;
    const Eigen::Vector2d end = range_m * Eigen::Vector2d{std::cos(angle_rad), std::sin(angle_rad)};
    beams.push_back({Beam{i, Eigen::Vector2d::Zero(), end, range_m}});
  }
  return beams;
}

}  // namespace waymark::test
