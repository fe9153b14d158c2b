// SPDX-License-Identifier: BSD-3-Clause
// Scans of a room in which every pose looks different.
#pragma once

#include "common/random/random.hpp"
#include "slam/core/scan/annotated_scan.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

namespace waymark::test {

/// Range from inside a room of 6 m x 4 m with a column, in the map frame.
inline double range_in_room(const Eigen::Vector2d& from, double direction_rad) {
  const Eigen::Vector2d ray{std::cos(direction_rad), std::sin(direction_rad)};
  double range_m = 100.0;
  if (ray.x() > 1e-9) range_m = std::min(range_m, (3.0 - from.x()) / ray.x());
  if (ray.x() < -1e-9) range_m = std::min(range_m, (-3.0 - from.x()) / ray.x());
  if (ray.y() > 1e-9) range_m = std::min(range_m, (2.0 - from.y()) / ray.y());
  if (ray.y() < -1e-9) range_m = std::min(range_m, (-2.0 - from.y()) / ray.y());
  const Eigen::Vector2d to_column = Eigen::Vector2d{1.5, 0.7} - from;
  const double ahead_m = ray.dot(to_column);
  const double beside_m = std::abs(ray.x() * to_column.y() - ray.y() * to_column.x());
  if (ahead_m > 0.0 && beside_m < 0.2)
    range_m = std::min(range_m, ahead_m - std::sqrt(0.04 - beside_m * beside_m));
  return range_m;
}

/// 360 beams around, noise of 1 cm.
inline std::vector<AnnotatedBeam> scan_of_room(const Se2& map_from_base) {
  std::vector<AnnotatedBeam> beams;
  Random random{3};
  for (int i = 0; i < 360; ++i) {
    const double bearing_rad = i * std::numbers::pi / 180.0;
    AnnotatedBeam annotated;
    annotated.beam.range_m =
        range_in_room(map_from_base.translation(), map_from_base.theta() + bearing_rad) +
        0.01 * random.normal();
    annotated.beam.end_in_base =
        annotated.beam.range_m * Eigen::Vector2d{std::cos(bearing_rad), std::sin(bearing_rad)};
    beams.push_back(annotated);
  }
  return beams;
}

}  // namespace waymark::test
